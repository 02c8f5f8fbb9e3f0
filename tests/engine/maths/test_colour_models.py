"""Colour models are those of Python's colorsys; blends of colours those of their definitions."""

import colorsys

import numpy as np
import pytest

from glanz.engine.maths import blending, colour_models
from glanz.engine.maths.blending import BLENDS

N = 500


def colours(seed, n=N):
    rng = np.random.default_rng(seed)
    found = rng.random((3, n))
    found[:, :20] = rng.random(20)
    found[:, 20:60] = rng.integers(0, 2, (3, 40))
    return found


def by_colorsys(function, given, order=(0, 1, 2)):
    return np.array([[function(*lane)[i] for i in order] for lane in given.T]).T


MODELS = {
    "hsv_from_rgb": lambda c: by_colorsys(colorsys.rgb_to_hsv, c),
    "rgb_from_hsv": lambda c: by_colorsys(colorsys.hsv_to_rgb, c),
    "hsl_from_rgb": lambda c: by_colorsys(colorsys.rgb_to_hls, c, (0, 2, 1)),
    "rgb_from_hsl": lambda c: by_colorsys(lambda h, s, lightness: colorsys.hls_to_rgb(h, lightness, s), c),
}


@pytest.mark.parametrize("name", MODELS)
def test_a_colour_model_is_that_of_python(name):
    given = colours(1)
    found = getattr(colour_models, name)(given.astype(np.float32))
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, MODELS[name](given), atol=3e-6)


def test_the_comparison_with_python_catches_a_hue_that_is_shifted(monkeypatch):
    right = colour_models.hsv_from_rgb
    monkeypatch.setattr(colour_models, "hsv_from_rgb", lambda c: right(c[[1, 2, 0]]))
    with pytest.raises(AssertionError):
        test_a_colour_model_is_that_of_python("hsv_from_rgb")


def replaced(a, b, which):
    """a with the components `which` of b's hue, saturation and value, unless b, or a where it gives the hue, has none."""
    x, y = by_colorsys(colorsys.rgb_to_hsv, a), by_colorsys(colorsys.rgb_to_hsv, b)
    z = np.where(np.isin(np.arange(3), which)[:, None], y, x)
    has_hue = {0: y[1] != 0, 1: x[1] != 0, 2: np.full(a.shape[1], True)}[min(which)]
    return np.where(has_hue, by_colorsys(colorsys.hsv_to_rgb, z), a)


def photoshop_burn(a, b):
    return np.where(b > 0, np.clip(1 - (1 - a) / np.where(b > 0, b, 1), 0, 1), 0)


FULL = {
    "mix": lambda a, b: b,
    "darken": np.minimum,
    "multiply": np.multiply,
    "burn": photoshop_burn,
    "lighten": np.maximum,
    "screen": lambda a, b: a + b - a * b,
    "dodge": lambda a, b: np.where(a == 0, 0, np.where(b < 1, np.minimum(a / np.where(b < 1, 1 - b, 1), 1), 1)),
    "add": np.add,
    "overlay": lambda a, b: np.where(a < 0.5, 2 * a * b, 1 - 2 * (1 - a) * (1 - b)),
    "soft light": lambda a, b: (1 - a) * a * b + a * (a + b - a * b),
    "linear light": lambda a, b: a + 2 * b - 1,
    "difference": lambda a, b: np.abs(a - b),
    "exclusion": lambda a, b: a + b - 2 * a * b,
    "subtract": np.subtract,
    "divide": lambda a, b: np.where(b != 0, a / np.where(b != 0, b, 1), a),
    "hue": lambda a, b: replaced(a, b, (0,)),
    "saturation": lambda a, b: replaced(a, b, (1,)),
    "color": lambda a, b: replaced(a, b, (0, 1)),
    "value": lambda a, b: replaced(a, b, (2,)),
}
"""What blends are by a factor of 1."""


def blended(name, a, b, t):
    return BLENDS[name](a.astype(np.float32), b.astype(np.float32), np.full((1, a.shape[1]), t, np.float32))


@pytest.mark.parametrize("name", BLENDS)
def test_a_blend_goes_from_its_first_colour_to_what_it_is_defined_as(name):
    a, b = colours(2), colours(3)
    np.testing.assert_allclose(blended(name, a, b, 0.0), a, atol=1e-6)
    np.testing.assert_allclose(blended(name, a, b, 1.0), FULL[name](a, b), rtol=2e-5, atol=2e-5)


@pytest.mark.parametrize("name", BLENDS)
def test_blends_are_told_apart(name, monkeypatch):
    for other in {*BLENDS} - {name}:
        monkeypatch.setitem(blending.BLENDS, name, BLENDS[other])
        with pytest.raises(AssertionError):
            np.testing.assert_allclose(blended(name, colours(2), colours(3), 1.0), FULL[name](colours(2), colours(3)), rtol=2e-5, atol=2e-5)
        monkeypatch.undo()
