"""Pictures are looked up as their twins, one texel at a time, say; mip maps keep what they average."""

import math

import numpy as np
import pytest

from glanz.engine.maths import lookup, mipmaps
from glanz.engine.maths.lookup import EXTENSIONS, INTERPOLATIONS, places
from glanz.engine.maths.mipmaps import Pyramid, decoding_table
from glanz.tests import helpers as h

SIZES = [(1, 1), (2, 2), (5, 3), (8, 8), (7, 16), (1, 9)]


def picture(size=(5, 3), seed=1):
    return np.random.default_rng(seed).random((*size, 4), np.float32)


def encoded(size=(5, 3), seed=1):
    """Without anything cut out."""
    texels = np.random.default_rng(seed).integers(0, 256, (*size, 4)).astype(np.uint8)
    texels[..., 3] = 255
    return texels


def points(n=500, seed=2):
    """x, y in [-3, 4], off the edges of texels."""
    return (np.random.default_rng(seed).random((2, n)) * 7 - 3).astype(np.float32)


def texel(texels, i, j, extension):
    """The scalar twin: texel column i, row j of a picture that goes on as `extension` says."""
    height, width, channels = texels.shape
    place = []
    for index, n in ((i, width), (j, height)):
        if extension == "repeat":
            index %= n
        elif extension == "mirror":
            index %= 2 * n
            index = 2 * n - 1 - index if index >= n else index
        elif extension == "extend":
            index = min(max(index, 0), n - 1)
        elif not 0 <= index < n:
            return np.zeros(channels)
        place.append(index)
    return texels[place[1], place[0]].astype(np.float64)


def spline(t):
    """The uniform cubic B-spline, by its recursion (de Boor 1978, IX (14)), knots at -2 to 2."""
    value = [1.0 if k <= t < k + 1 else 0.0 for k in range(-2, 2)]
    for order in range(1, 4):
        value = [((t - k) * value[i] + (k + order + 1 - t) * value[i + 1]) / order for i, k in enumerate(range(-2, 2 - order))]
    return value[0]


KERNELS = {"closest": (1, lambda t: 1.0 if -0.5 < t <= 0.5 else 0.0), "linear": (1, lambda t: max(1 - abs(t), 0)), "cubic": (2, spline)}


def twin(texels, x, y, extension, interpolation):
    height, width, _ = texels.shape
    radius, kernel = KERNELS[interpolation]
    px, py = x * width - 0.5, y * height - 0.5
    around = [range(math.floor(p) - radius, math.floor(p) + radius + 2) for p in (px, py)]
    return sum(kernel(px - i) * kernel(py - j) * texel(texels, i, j, extension) for j in around[1] for i in around[0])


def look_up(pyramid, x, y, extension="repeat", interpolation="linear"):
    return pyramid.colours(places(pyramid.layout, x, y, None, extension, interpolation))


@pytest.mark.parametrize("extension", EXTENSIONS)
@pytest.mark.parametrize("interpolation", INTERPOLATIONS)
@pytest.mark.parametrize("size", SIZES)
def test_lookup_is_that_of_the_scalar_twin(extension, interpolation, size):
    texels, (x, y) = picture(size), points()
    pyramid = Pyramid.of(texels, False)
    where = places(pyramid.layout, x, y, None, extension, interpolation)
    found = np.concatenate((pyramid.colours(where), pyramid.alpha(where)))
    expected = np.array([twin(texels, float(a), float(b), extension, interpolation) for a, b in zip(x, y)]).T
    assert found.dtype == np.float32
    # Coordinates of magnitude 4 rounded to float32, times the size in texels.
    close = np.abs(found - expected).max(axis=0) <= 4 * max(size) * 2.0**-22
    assert close.mean() > 0.99 if interpolation == "closest" else close.all()


def test_lookup_catches_texels_that_are_off_by_a_half(monkeypatch):
    left_of = lookup._left_of
    monkeypatch.setattr(lookup, "_left_of", lambda x, n: left_of(x + np.float32(0.5 / 5), n))
    with pytest.raises(AssertionError):
        test_lookup_is_that_of_the_scalar_twin("repeat", "linear", (5, 3))


def test_codes_are_interpolated_and_light_is_averaged():
    """As Cycles has it, half way between black and white there is half of the code; a mip map has half of the light."""
    texels = encoded((1, 2))
    texels[:, 0, :3], texels[:, 1, :3] = 0, 255
    for is_srgb, expected in ((True, ((0.5 + 0.055) / 1.055) ** 2.4), (False, 0.5)):
        pyramid = Pyramid.of(texels, is_srgb)
        assert look_up(pyramid, np.float32([0.5]), np.float32([0.5]), "extend") == pytest.approx(expected, abs=1e-4)
        assert pyramid.coarse[0] == pytest.approx((0.5, 0.5, 0.5, 1))


@pytest.mark.parametrize("is_srgb", [True, False])
def test_every_byte_is_decoded_to_the_bit(is_srgb):
    texels = np.broadcast_to(np.arange(256, dtype=np.uint8)[:, None], (16, 16, 4) if False else (256, 4)).reshape(16, 16, 4).copy()
    x, y = np.meshgrid(*[(np.arange(16, dtype=np.float32) + 0.5) / 16] * 2)
    found = look_up(Pyramid.of(texels, is_srgb), x.ravel(), y.ravel(), "extend")
    np.testing.assert_allclose(found[0], decoding_table(is_srgb), rtol=2e-7, atol=0)


def test_colours_that_were_cut_out_are_divided_by_alpha_as_they_are_encoded():
    """Half of a cover of code 200 beside nothing: wherever it is looked up it is 200, only less of it is there."""
    texels = np.zeros((1, 2, 4), np.uint8)
    texels[:, 0] = 100, 100, 100, 128
    pyramid = Pyramid.of(texels, True, is_uncut=True)
    x = np.linspace(0.25, 0.7, 20, dtype=np.float32)
    where = places(pyramid.layout, x, np.full_like(x, 0.5), None, "extend", "linear")
    straight = decoding_table(True)[199:201].mean()
    assert pyramid.colours(where) == pytest.approx(straight, abs=2e-3)
    np.testing.assert_allclose(pyramid.alpha(where)[0], (1 - (2 * x - 0.5)) * 128 / 255, atol=1e-6)
    assert pyramid.coarse[0, :3] / pyramid.coarse[0, 3] == pytest.approx(straight, abs=2e-3)
    assert pyramid.coarse[0, 3] == pytest.approx(64 / 255)


def test_the_decoding_is_the_standards():
    """IEC 61966-2-1, at codes 0, 10 (linear part), 128, 188 and 255."""
    table = decoding_table(True)
    assert table[[0, 10, 128, 188, 255]] == pytest.approx([0, 10 / 255 / 12.92, 0.2158605, 0.5028865, 1], abs=1e-6)
    assert h.same_bits(decoding_table(False), (np.arange(256) / 255).astype(np.float32))


@pytest.mark.parametrize("size", SIZES)
def test_every_level_has_the_mean_of_the_picture(size):
    for texels in (picture(size), encoded(size)):
        pyramid = Pyramid.of(texels, True)
        colours = texels[..., :3]
        truth = (decoding_table(True).take(colours) if texels.dtype == np.uint8 else colours).mean(axis=(0, 1), dtype=np.float64)
        layout = pyramid.layout
        for level in range(1, layout.width.size):
            part = pyramid.coarse[layout.start[level] :][: layout.width[level] * layout.height[level]]
            assert part[:, :3].mean(axis=0, dtype=np.float64) == pytest.approx(truth, abs=1e-6)
        assert layout.width[-1] == layout.height[-1] == 1


def test_means_catch_encodings_that_are_averaged(monkeypatch):
    texels = encoded((8, 8))
    truth = decoding_table(True).take(texels[..., :3]).mean(axis=(0, 1))
    monkeypatch.setattr(mipmaps, "decoding_table", lambda is_srgb, steps=256: decoding_table(False, steps))
    assert np.abs(Pyramid.of(texels, True).coarse[-1, :3] - truth).min() > 0.05


def filtered(pyramid, x, y, a, b, extension="repeat"):
    n = x.size
    axes = [np.broadcast_to(np.float32(axis)[:, None], (2, n)) for axis in (a, b)]
    return pyramid.colours(places(pyramid.layout, x, y, axes, extension, "linear"))


def test_a_footprint_within_a_texel_is_a_lookup_to_the_bit():
    pyramid, (x, y) = Pyramid.of(encoded((16, 8)), True), points()
    assert h.same_bits(filtered(pyramid, x, y, (0.4 / 8, 0), (0, 0.1 / 16)), look_up(pyramid, x, y))


def test_pictures_of_one_size_share_where_they_are_looked_up():
    texels, (x, y) = [encoded((16, 8), seed) for seed in (1, 2)], points()
    axes = np.random.default_rng(1).random((2, 2, x.size), np.float32) * 0.5
    first, second = (Pyramid.of(t, True) for t in texels)
    assert first.layout is second.layout
    shared = places(first.layout, x, y, axes, "repeat", "linear")
    assert h.same_bits(second.colours(shared), second.colours(places(second.layout, x, y, axes, "repeat", "linear")))


@pytest.mark.parametrize("turned", [False, True])
def test_a_footprint_along_one_axis_blurs_along_it_alone(turned):
    """Stripes across the long axis are averaged away, stripes along it stay: that is what one round level could not do."""
    i = np.arange(64)
    stripes = np.broadcast_to((i % 2).astype(np.float32)[:, None], (64, 64, 4)).copy()
    pyramid = Pyramid.of(stripes.transpose(1, 0, 2).copy() if turned else stripes, False)
    x, y = points()
    long, short = ((0, 4.0 / 64), (0.25 / 64, 0)) if turned else ((4.0 / 64, 0), (0, 0.25 / 64))
    across = filtered(pyramid, x, y, long, short)
    assert np.abs(across - 0.5).max() <= 0.08
    along = filtered(pyramid, x, y, *((short[::-1], long[::-1])))
    assert np.abs(along - look_up(pyramid, x, y)).max() <= 1e-4


def test_a_footprint_as_large_as_the_picture_is_its_mean():
    texels = encoded((32, 16))
    pyramid, (x, y) = Pyramid.of(texels, True), points()
    mean = decoding_table(True).take(texels[..., :3]).mean(axis=(0, 1))[:, None]
    for a, b in (((40, 0), (0, 40)), ((3, 0), (0, 2)), ((1e6, 1), (0, 1e3))):
        assert np.abs(filtered(pyramid, x, y, a, b) - mean).max() <= 2e-6


def wave():
    """A pyramid of one period of a sine along x, and points close around its middle, where it is highest in slope."""
    i = np.arange(64) / 64
    values = (0.5 + 0.5 * np.sin(2 * np.pi * i)).astype(np.float32)
    x = (0.3 + 1e-4 * np.random.default_rng(1).random(4000)).astype(np.float32)
    return Pyramid.of(np.broadcast_to(values[:, None], (64, 64, 4)).copy(), False), x


def test_between_levels_there_is_no_step_on_average():
    """Footprints that grow by 1 % change the mean over places beside each other by no more than 3 %."""
    pyramid, x = wave()
    means = np.array([filtered(pyramid, x, x, (r, 0), (0, r)).mean(axis=1) for r in 0.001 * 1.01 ** np.arange(600)])
    assert np.abs(np.diff(means, axis=0)).max() <= 0.03
    assert np.ptp(means) > 0.2


def test_the_mean_between_levels_catches_levels_that_are_rounded(monkeypatch):
    monkeypatch.setattr(lookup, "_number_of", lambda x, y: np.full_like(x, 0.3))
    with pytest.raises(AssertionError):
        test_between_levels_there_is_no_step_on_average()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e30])
def test_coordinates_beyond_reason_end_in_no_exception(value):
    pyramid = Pyramid.of(encoded((5, 3)), True)
    x = np.float32([value, 0.5])
    with np.errstate(all="ignore"):
        for extension in EXTENSIONS:
            for interpolation in INTERPOLATIONS:
                assert np.isfinite(look_up(pyramid, x, x, extension, interpolation)[:, 1]).all()
            for long in (3, value):
                assert np.isfinite(filtered(pyramid, x, x, (3, 0), (0, long), extension)[:, 1]).all()


def test_points_here_and_there_are_looked_up_once_and_see_the_same_on_average():
    """Over the length of a footprint, points of which each sees but its own middle see what one that sees all of it does."""
    pyramid, x = wave()
    n, half = x.size, np.float32(0.2)
    axes = [np.broadcast_to(np.float32(axis)[:, None], (2, n)) for axis in ((half, 0), (0, 0.02))]
    along = x + half * np.linspace(-1, 1, n, dtype=np.float32)
    whole = places(pyramid.layout, x, x, axes, "repeat", "linear", np.ones(n, bool))
    each = places(pyramid.layout, along, x, axes, "repeat", "linear", np.zeros(n, bool))
    assert each.count == n < whole.count
    assert np.abs(pyramid.colours(each).mean(axis=1) - pyramid.colours(whole).mean(axis=1)).max() <= 0.01


def test_even_points_are_those_of_which_nothing_is_said():
    pyramid, (x, y) = Pyramid.of(encoded((16, 8)), True), points()
    axes = np.random.default_rng(1).random((2, 2, x.size), np.float32) * 0.5
    said, unsaid = (places(pyramid.layout, x, y, axes, "repeat", "linear", even) for even in (np.ones(x.size, bool), None))
    assert h.same_bits(pyramid.colours(said), pyramid.colours(unsaid))
