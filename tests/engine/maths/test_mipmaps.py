"""Pictures are looked up as their twins, one texel at a time, say; mip maps keep what they average."""

import math

import numpy as np
import pytest

from glanz.engine.maths import mipmaps
from glanz.engine.maths.mipmaps import EXTENSIONS, Pyramid, decoding_table
from glanz.tests import helpers as h

SIZES = [(1, 1), (2, 2), (5, 3), (8, 8), (7, 16), (1, 9)]


def picture(size=(5, 3), seed=1):
    return np.random.default_rng(seed).random((3, *size), np.float32)


def encoded(size=(5, 3), seed=1):
    return np.random.default_rng(seed).integers(0, 256, (3, *size)).astype(np.uint8)


def points(n=500, seed=2):
    """x, y in [-3, 4], off the edges of texels."""
    return (np.random.default_rng(seed).random((2, n)) * 7 - 3).astype(np.float32)


def texel(pixels, i, j, extension):
    """The scalar twin: texel column i, row j of a picture that goes on as `extension` says."""
    _, height, width = pixels.shape
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
            return np.zeros(3)
        place.append(index)
    return pixels[:, place[1], place[0]].astype(np.float64)


def twin(pixels, x, y, extension, is_smooth):
    _, height, width = pixels.shape
    if not is_smooth:
        return texel(pixels, math.floor(x * width), math.floor(y * height), extension)
    px, py = x * width - 0.5, y * height - 0.5
    i, j = math.floor(px), math.floor(py)
    fx, fy = px - i, py - j
    near, far = ((1 - fx) * texel(pixels, i, k, extension) + fx * texel(pixels, i + 1, k, extension) for k in (j, j + 1))
    return (1 - fy) * near + fy * far


@pytest.mark.parametrize("extension", EXTENSIONS)
@pytest.mark.parametrize("is_smooth", [False, True])
@pytest.mark.parametrize("size", SIZES)
def test_lookup_is_that_of_the_scalar_twin(extension, is_smooth, size):
    pixels, (x, y) = picture(size), points()
    pyramid = Pyramid.of(pixels, False)
    found = (pyramid.bilinear if is_smooth else pyramid.nearest)(x, y, extension)
    expected = np.array([twin(pixels, float(a), float(b), extension, is_smooth) for a, b in zip(x, y)]).T
    assert found.dtype == np.float32
    # Coordinates of magnitude 4 rounded to float32, times the size in texels.
    close = np.abs(found - expected).max(axis=0) <= 4 * max(size) * 2.0**-22
    assert close.all() if is_smooth else close.mean() > 0.99


def test_lookup_catches_texels_that_are_off_by_a_half(monkeypatch):
    neighbours = mipmaps._neighbours
    monkeypatch.setattr(mipmaps, "_neighbours", lambda x, n, extension: neighbours(x + np.float32(0.5 / 5), n, extension))
    with pytest.raises(AssertionError):
        test_lookup_is_that_of_the_scalar_twin("repeat", True, (5, 3))


def test_bytes_are_decoded_before_they_are_interpolated():
    """Half way between black and white there is half of the light, not of the code."""
    pixels = np.zeros((3, 1, 2), np.uint8)
    pixels[:, :, 1] = 255
    for is_srgb in (True, False):
        middle = Pyramid.of(pixels, is_srgb).bilinear(np.float32([0.5]), np.float32([0.5]), "extend")
        assert middle == pytest.approx(0.5)
        assert Pyramid.of(pixels, is_srgb).coarse[:, 0] == pytest.approx(0.5)


def test_the_decoding_is_the_standards():
    """IEC 61966-2-1, at codes 0, 10 (linear part), 128, 188 and 255."""
    table = decoding_table(True)
    assert table[[0, 10, 128, 188, 255]] == pytest.approx([0, 10 / 255 / 12.92, 0.2158605, 0.5028865, 1], abs=1e-6)
    assert h.same_bits(decoding_table(False), (np.arange(256) / 255).astype(np.float32))


@pytest.mark.parametrize("size", SIZES)
def test_every_level_has_the_mean_of_the_picture(size):
    for pixels in (picture(size), encoded(size)):
        pyramid = Pyramid.of(pixels, True)
        truth = (decoding_table(True).take(pixels) if pixels.dtype == np.uint8 else pixels).mean(axis=(1, 2), dtype=np.float64)
        for level in range(1, pyramid.width.size):
            w, height, start = pyramid.width[level], pyramid.height[level], pyramid.start[level]
            texels = pyramid.coarse[:, start : start + w * height]
            assert texels.mean(axis=1, dtype=np.float64) == pytest.approx(truth, abs=1e-6)
        assert pyramid.width[-1] == pyramid.height[-1] == 1


def test_means_catch_encodings_that_are_averaged(monkeypatch):
    pixels = encoded((8, 8))
    truth = decoding_table(True).take(pixels).mean(axis=(1, 2))
    monkeypatch.setattr(mipmaps, "decoding_table", lambda is_srgb: decoding_table(False))
    assert np.abs(Pyramid.of(pixels, True).coarse[:, -1] - truth).min() > 0.05


def filtered(pyramid, x, y, a, b, extension="repeat"):
    n = x.size
    axes = [np.broadcast_to(np.float32(axis)[:, None], (2, n)) for axis in (a, b)]
    return pyramid.filtered(x, y, axes, extension, pyramid.bilinear)


def test_a_footprint_within_a_texel_is_a_lookup_to_the_bit():
    pyramid, (x, y) = Pyramid.of(encoded((16, 8)), True), points()
    assert h.same_bits(filtered(pyramid, x, y, (0.4 / 8, 0), (0, 0.1 / 16)), pyramid.bilinear(x, y, "repeat"))


@pytest.mark.parametrize("turned", [False, True])
def test_a_footprint_along_one_axis_blurs_along_it_alone(turned):
    """Stripes across the long axis are averaged away, stripes along it stay: that is what one round level could not do."""
    i = np.arange(64)
    stripes = np.broadcast_to((i % 2).astype(np.float32), (3, 64, 64)).copy()
    pyramid = Pyramid.of(stripes.transpose(0, 2, 1).copy() if turned else stripes, False)
    x, y = points()
    long, short = ((0, 4.0 / 64), (0.25 / 64, 0)) if turned else ((4.0 / 64, 0), (0, 0.25 / 64))
    across = filtered(pyramid, x, y, long, short)
    assert np.abs(across - 0.5).max() <= 0.08
    along = filtered(pyramid, x, y, *((short[::-1], long[::-1])))
    sharp = pyramid.bilinear(x, y, "repeat")
    assert np.abs(along - sharp).max() <= 1e-4


def test_a_footprint_as_large_as_the_picture_is_its_mean():
    pixels = encoded((32, 16))
    pyramid, (x, y) = Pyramid.of(pixels, True), points()
    mean = decoding_table(True).take(pixels).mean(axis=(1, 2))[:, None]
    for a, b in (((40, 0), (0, 40)), ((3, 0), (0, 2)), ((1e6, 1), (0, 1e3))):
        assert np.abs(filtered(pyramid, x, y, a, b) - mean).max() <= 2e-6


def test_between_levels_there_is_no_step():
    """Footprints that grow by 1 % change a smooth picture by no more than 3 %."""
    i = np.arange(64) / 64
    wave = (0.5 + 0.5 * np.sin(2 * np.pi * i)).astype(np.float32)
    pyramid = Pyramid.of(np.broadcast_to(wave, (3, 64, 64)).copy(), False)
    x, y = points(50)
    values = np.array([filtered(pyramid, x, y, (r, 0), (0, r)) for r in 0.001 * 1.01 ** np.arange(600)])
    assert np.abs(np.diff(values, axis=0)).max() <= 0.03


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e30])
def test_coordinates_beyond_reason_end_in_no_exception(value):
    pyramid = Pyramid.of(encoded((5, 3)), True)
    x = np.float32([value, 0.5])
    with np.errstate(all="ignore"):
        for extension in EXTENSIONS:
            for lookup in (pyramid.nearest, pyramid.bilinear):
                assert np.isfinite(lookup(x, x, extension)[:, 1]).all()
            assert np.isfinite(filtered(pyramid, x, x, (3, 0), (0, 2), extension)[:, 1]).all()
