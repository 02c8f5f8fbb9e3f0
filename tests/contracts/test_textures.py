"""What every texture promises (`interfaces.Texture`), checked for every class in the registry; EXAMPLES adds known ones."""

import dataclasses

import numpy as np
import pytest

from glanz.engine import (
    TEXTURES,
    Bitmap,
    CheckerTexture,
    Coordinates,
    GradientTexture,
    ImageTexture,
    LinearTexture,
    NoiseTexture,
    SceneError,
)
from glanz.engine.interfaces import Texture
from glanz.engine.scene.textured import with_inner
from glanz.engine.textures.gradient import _SHAPES
from glanz.tests import helpers as h

PICTURE = Bitmap(name="picture", pixels=np.random.default_rng(1).integers(0, 256, (3, 9, 16)).astype(np.uint8))
BRIGHT = Bitmap(name="bright", pixels=np.random.default_rng(2).random((3, 4, 5), np.float32) * 3)
IMAGES = [ImageTexture(PICTURE, extension=e, is_smooth=s) for e in ("repeat", "extend", "clip", "mirror") for s in (True, False)]
EXAMPLES = {
    "image": [*IMAGES, ImageTexture(BRIGHT)],
    "checker": [CheckerTexture((0.9, 0.1, 0.3), (0.0, 0.5, 0.3))],
    "noise": [NoiseTexture(is_coloured=True, detail=3.5), NoiseTexture(distortion=2.0), NoiseTexture(is_normalized=False)],
    "gradient": [GradientTexture(shape) for shape in _SHAPES],
    "linear": [
        LinearTexture((IMAGES[0], NoiseTexture(is_normalized=False)), ((0.5, -0.25, 1.0), (0.1, 2.0, -1.0)), (0.1, 0.2, 0.3)),
        LinearTexture((ImageTexture(BRIGHT),), ((0.5, 0.5, 0.5),), is_clipped=True),
    ],
}
ALL = [value for key, plugin in TEXTURES.items() for value in EXAMPLES.get(key, [plugin()])]
N = 4096

each = pytest.mark.parametrize("value", ALL, ids=lambda v: v.key)


class Points:
    """Points as textures are handed them: p (3, N), with footprints of half-axes `axes` if any."""

    def __init__(self, p, axes=None):
        self.p, self.axes = p, axes

    def look_up(self, coordinates):
        return self.p, self.axes

    def value(self, texture):
        return texture.eval(self)


def somewhere(seed=1, n=N, scale=8.0):
    return ((np.random.default_rng(seed).random((3, n)) - 0.25) * scale).astype(np.float32)


def colour(value, at):
    """eval, one column for each point."""
    found = value.eval(at)
    return np.broadcast_to(found, (3, at.p.shape[1]))


def square(radius, n=N):
    """Footprints of equal half-axes along x and y."""
    axes = np.zeros((2, 3, n), np.float32)
    axes[0, 0] = axes[1, 1] = radius
    return tuple(axes)


@pytest.mark.parametrize("plugin", TEXTURES.values(), ids=lambda p: p.key)
def test_a_texture_has_all_that_the_interface_asks_for(plugin):
    assert isinstance(plugin(), Texture)
    plugin().check("owner")
    assert plugin() == plugin()
    assert hash(plugin()) == hash(plugin())


@each
def test_values_are_within_the_bounds_and_finite(value):
    low, high = (np.array(end)[:, None] for end in value.bounds())
    for axes in (None, square(0.01), square(1.0)):
        found = colour(value, Points(somewhere(), axes))
        assert found.dtype == np.float32
        assert (found >= low - 1e-6).all()
        assert (found <= high + 1e-6).all()


def test_bounds_catch_a_texture_that_exceeds_them(monkeypatch):
    monkeypatch.setattr(CheckerTexture, "bounds", lambda self: ((0.1,) * 3, (0.8,) * 3))
    with pytest.raises(AssertionError):
        test_values_are_within_the_bounds_and_finite(EXAMPLES["checker"][0])


@each
def test_the_average_is_what_to_expect(value):
    """Over many periods; gradients, and pictures that do not repeat, have none. To 0.03: it is for choosing alone."""
    if any(isinstance(t, GradientTexture) or getattr(t, "extension", "repeat") in ("extend", "clip") for t in with_inner(value)):
        return
    found = colour(value, Points(somewhere(n=100_000, scale=64.0))).mean(axis=1)
    # What is cut off and then averaged is not what is averaged and then cut off.
    assert np.abs(found - value.average()).max() <= (0.1 if getattr(value, "is_clipped", False) else 0.03)


@each
def test_lanes_are_independent(value):
    """One lane alone gives the bits that it gives among others."""
    p, axes = somewhere(n=1003), square(0.2, 1003)
    for across in (None, axes):
        whole = colour(value, Points(p, across))
        for lanes in (slice(0, 1), slice(500, 501), slice(7, 24)):
            part = colour(value, Points(p[:, lanes].copy(), across and tuple(a[:, lanes].copy() for a in across)))
            assert h.same_bits(part, whole[:, lanes].copy())


@each
def test_a_footprint_without_extent_is_a_point(value):
    """Up to rounding, and off the edges between texels or cubes."""
    p = somewhere()
    sharp, averaged = colour(value, Points(p)), colour(value, Points(p, square(0.0)))
    assert (np.abs(sharp - averaged).max(axis=0) <= 1e-5).mean() > 0.999


@each
def test_a_wide_footprint_sees_the_average(value):
    """As wide as many periods: the average, to 1 %; where there are no periods there is nothing to average over."""
    if not all(part.has_detail or part.key == "linear" for part in with_inner(value)) or (value.key == "linear" and value.is_clipped):
        return
    if any(getattr(t, "extension", "repeat") in ("extend", "clip") for t in with_inner(value)):
        return
    axes = np.full((2, 3, N), 100, np.float32) * np.float32([[[1]], [[0.7]]])
    found = colour(value, Points(somewhere(), tuple(axes)))
    assert np.abs(found - np.array(value.average())[:, None]).max() <= 0.01


def test_wide_footprints_catch_a_checker_that_ignores_them(monkeypatch):
    unfiltered = CheckerTexture.eval
    monkeypatch.setattr(CheckerTexture, "eval", lambda self, at: unfiltered(self, Points(at.p)))
    with pytest.raises(AssertionError):
        test_a_wide_footprint_sees_the_average(EXAMPLES["checker"][0])


@pytest.mark.parametrize(
    ("value", "word"),
    [
        (ImageTexture(PICTURE, extension="wrap"), "wrap"),
        (ImageTexture(Bitmap(name="holes", pixels=np.full((3, 2, 2), np.nan, np.float32))), "holes"),
        (NoiseTexture(detail=-1.0), "detail"),
        (NoiseTexture(detail=16.0), "detail"),
        (NoiseTexture(roughness=float("nan")), "roughness"),
        (NoiseTexture(lacunarity=float("inf")), "lacunarity"),
        (GradientTexture("steep"), "steep"),
        (LinearTexture((IMAGES[0],), ()), "factors"),
        (LinearTexture((IMAGES[0],), ((1, 2),)), "factors"),
        (LinearTexture((IMAGES[0],), (("a", 1, 2),)), "factors"),
    ],
)
def test_parameters_out_of_range_are_refused_by_name(value, word):
    with pytest.raises(SceneError, match=word) as error:
        value.check("Wood")
    assert "'Wood'" in str(error.value)


def test_coordinates_out_of_range_are_refused():
    with pytest.raises(SceneError, match="camera"):
        Coordinates(source="camera").check("Wood")
    with pytest.raises(SceneError, match="finite"):
        Coordinates(matrix=np.full((4, 4), np.inf)).check("Wood")
    with pytest.raises(SceneError, match="shape"):
        Coordinates(matrix=np.eye(3))


def test_textures_are_values():
    for value in ALL:
        assert dataclasses.replace(value) == value
