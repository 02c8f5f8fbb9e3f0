"""Whatever is thrown at it, a render ends with a finite picture or a clear refusal (faults J14-J19, catalogue E11).

Scenes are drawn by Hypothesis, see `anything`: degenerate and empty meshes, sizes from 1e-38 to 1e38 and numbers that are none; all lobes,
textures, lights, cameras, integrators, samplers, filters and passes.
"""

import time
from contextlib import closing
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given

from glanz.engine import GlanzError, PerspectiveCamera, Settings, SunLight, gathered, render
from glanz.tests import anything, helpers as h
from glanz.tests.chance import law

SIGNED = ("mitchell",)
"""Filters that count some of a pixel's surroundings negatively."""
UNKNOWN = {"Confidence": np.inf, "Standard Error": np.inf}
"""What passes say where they cannot know."""
HANGS = 30.0
"""Seconds, hundreds of times what any of these scenes takes."""


def watched(steps, hangs=HANGS):
    """The `steps` of a render; AssertionError where it does not end."""
    begun = time.monotonic()
    with closing(steps):
        for step in steps:
            assert time.monotonic() - begun < hangs, "it hangs"
            yield step


def check_one_line(error):
    assert str(error)
    assert "\n" not in str(error)


def check_any(scene, way):
    """A finite picture with every pass, or one line that says why not. Bad samples may be told, never seen."""
    x0, y0, x1, y1 = way.region
    try:
        passes, warnings, _ = gathered(watched(render(scene, way)), way)
    except GlanzError as error:
        check_one_line(error)
        return
    for line in warnings:
        check_one_line(line)
    assert passes.keys() == {*way.passes}
    for name, values in passes.items():
        assert values.shape[:2] == (y1 - y0, x1 - x0)
        assert np.isfinite(values[values != UNKNOWN.get(name)]).all(), name
    assert way.pixel_filter in SIGNED or (passes["Combined"] >= 0).all()
    lengths = np.linalg.norm(passes["Normal"], axis=2)
    assert way.pixel_filter in SIGNED or (lengths <= 1 + 1e-5).all()


@given(anything.cases())
@law(quick=200, thorough=10_000)
def test_any_scene_renders_to_finite_numbers_or_is_refused(case):
    if isinstance(case, GlanzError):
        check_one_line(case)
    else:
        check_any(*case)


def test_any_scene_catches_a_render_that_hangs():
    """The mutant goes on and on."""
    with pytest.raises(AssertionError, match="it hangs"):
        list(watched((None for _ in range(10**9)), hangs=0.01))


def test_any_scene_catches_a_film_that_keeps_what_is_not_finite(monkeypatch):
    """The mutant trusts every sample; a sun of 1e30 W / m^2 in a millionth of a degree is more than float32 holds."""
    scene = h.scene([h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)))], [SunLight(irradiance=(1e38,) * 3, angle=1e-6, is_visible=True)])
    scene = h.replaced(scene, camera=PerspectiveCamera.look_at((0, 0, 1), (0, 0, 3), up=(0, 1, 0), fov=1e-7))
    way = Settings(width=8, height=8, samples=2, threads=1, passes=("Combined", "Depth", "Normal"))
    check_any(scene, way)
    monkeypatch.setattr("glanz.engine.wavefront.film.np", SimpleNamespace(**{**vars(np), "isfinite": np.ones_like}))
    with pytest.raises(AssertionError):
        check_any(scene, way)
