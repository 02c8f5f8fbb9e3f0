"""Whatever is thrown at it, a render ends with a finite picture or a clear refusal (faults J14-J19, catalogue E11).

Scenes are drawn by Hypothesis, see `anything`: degenerate and empty meshes, sizes from 1e-38 to 1e38 and numbers that are none; all lobes,
textures, lights, cameras, integrators, samplers, filters and passes.
"""

import sys
import time
from contextlib import closing, contextmanager
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given

from glanz.engine import GlanzError, PerspectiveCamera, Settings, SunLight, arrays, gathered, prepare, render, render_plan
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


trusting = arrays.gather


def checked(a, lanes):
    """`arrays.gather`, which trusts its indices: huge ones would never end."""
    lanes = np.asarray(lanes)
    if lanes.size and lanes.dtype != bool and not -a.shape[-1] <= lanes.min() <= lanes.max() < a.shape[-1]:
        raise IndexError(f"{lanes.min()} to {lanes.max()} of {a.shape[-1]}")
    return trusting(a, lanes)


@contextmanager
def nothing_is_trusted():
    """Whatever is gathered is checked."""
    with pytest.MonkeyPatch.context() as patch:
        for name, module in list(sys.modules.items()):
            if name.startswith("glanz.engine.") and getattr(module, "gather", None) is trusting:
                patch.setattr(module, "gather", checked)
        yield


@given(anything.cases())
@law(quick=150, thorough=10_000)
def test_any_scene_renders_to_finite_numbers_or_is_refused(case):
    """Nor is any number that is none made a whole one by which something is looked up without a look."""
    if isinstance(case, GlanzError):
        check_one_line(case)
        return
    with nothing_is_trusted():
        check_any(*case)


def test_an_index_that_is_garbage_is_noticed():
    """The mutant lets triangles wear a material that there is not."""
    scene = h.scene([h.thing(h.quad(), h.lambert(share, f"of {share}")) for share in (0.3, 0.6)], world=0.5)
    plan, _ = prepare(scene, h.settings())
    plan.world.triangles.material[:] = 2**31 - 1
    with nothing_is_trusted(), pytest.raises(IndexError):
        list(render_plan(plan))


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
