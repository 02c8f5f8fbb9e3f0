"""Materials whose textures ask for more light than there is."""

import numpy as np
import pytest

from glanz.engine import Coordinates, GradientTexture, Lambert, LinearTexture, Material, Transparent
from glanz.engine.world import filling
from glanz.tests import helpers as h, textured as t

SQUARE = t.with_uvs(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)))
RAMP = GradientTexture("linear", Coordinates())
LIMITED = {
    "one lobe": (Lambert(LinearTexture((RAMP,), (2.0,))), lambda x: np.minimum(2 * x, 1)),
    "beside a constant one": ((Lambert((0.5,) * 3), Lambert(LinearTexture((RAMP,), (2.0,)))), lambda x: np.minimum(0.5 + 2 * x, 1)),
    "beside a veil": ((Lambert(LinearTexture((RAMP,), (2.0,))), Transparent(RAMP)), lambda x: np.minimum(3 * x, 1)),
}


@pytest.mark.parametrize(("lobes", "expected"), LIMITED.values(), ids=LIMITED)
def test_what_textures_make_too_bright_reflects_just_all_that_does_not_pass(lobes, expected):
    """In an even white world, where each point shows its albedo; to 3 % of 4,096 samples' mean over a column of pixels."""
    material = Material(name="m", lobes=lobes if isinstance(lobes, tuple) else (lobes,))
    settings = h.settings(width=8, height=8, samples=256, max_depth=1, filter_width=0.01)
    found = h.pixels(t.facing(SQUARE, material, world=1.0), settings)[0]
    at = h.pixels(t.facing(SQUARE, Material(name="m", emission=RAMP), world=0.0), settings)[0]
    assert np.abs(found.mean(axis=0) - expected(at).mean(axis=0)).max() <= 0.03


def test_the_limit_catches_lobes_that_are_not_darkened(monkeypatch):
    monkeypatch.setattr(filling, "_limit", lambda *args: None)
    with pytest.raises(AssertionError):
        test_what_textures_make_too_bright_reflects_just_all_that_does_not_pass(*LIMITED["one lobe"])
