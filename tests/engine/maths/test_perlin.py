"""Noise is that of its scalar twin in float64; that it is Blender's is seen by the parity tests."""

import math

import numpy as np
import pytest

from glanz.engine.maths import perlin
from glanz.engine.maths.perlin import MEAN_SIZES, noise, offset
from glanz.tests.engine.maths.test_cellhash import MASK, twin_hash, twin_unit

SCALES = {1: 0.25, 2: 0.6616, 3: 0.982, 4: 0.8344}
each = pytest.mark.parametrize("dimensions", [1, 2, 3, 4])


def gradient(kind, d):
    """The product of the way d with the gradient of a corner: to the middles of the edges of a cube (Perlin 2002), and likewise."""

    def signed(x, bit):
        return -x if kind & bit else x

    if len(d) == 1:
        return signed(1 + (kind & 7), 8) * d[0]
    if len(d) == 2:
        first, second = d if kind & 7 < 4 else d[::-1]
        return signed(first, 1) + signed(2 * second, 2)
    if len(d) == 3:
        kind &= 15
        first = d[0] if kind < 8 else d[1]
        second = d[1] if kind < 4 else d[0] if kind in (12, 14) else d[2]
        return signed(first, 1) + signed(second, 2)
    kind &= 31
    return sum(signed(d[i if kind < (24, 16, 8)[i] else i + 1], 1 << i) for i in range(3))


def twin_noise(*p):
    """Perlin 2002 in float64, in any number of dimensions: quintic fade between the corners of a cell."""
    cell = [math.floor(c) for c in p]
    f = [c - i for c, i in zip(p, cell)]
    fade = [t**3 * (t * (6 * t - 15) + 10) for t in f]
    total = 0.0
    for corner in np.ndindex(*(2,) * len(p)):
        kind = twin_hash(*((i + s) & MASK for i, s in zip(cell, corner)))
        weight = math.prod(w if s else 1 - w for w, s in zip(fade, corner))
        total += weight * gradient(kind, [t - s for t, s in zip(f, corner)])
    return SCALES[len(p)] * total


def places(n=200, scale=20.0, dimensions=3):
    return ((np.random.default_rng(5).random((dimensions, n)) - 0.5) * scale).astype(np.float32)


@each
def test_noise_is_that_of_the_twin(dimensions):
    p = places(dimensions=dimensions)
    expected = [twin_noise(*map(float, q)) for q in p.T]
    assert np.abs(noise(p) - expected).max() <= 1e-5
    assert noise(p).dtype == np.float32


@each
def test_the_twin_catches_another_gradient(dimensions, monkeypatch):
    products = perlin._products
    monkeypatch.setattr(perlin, "_products", lambda hashes, *ways: products(hashes ^ np.uint32(9), *ways))
    with pytest.raises(AssertionError):
        test_noise_is_that_of_the_twin(dimensions)


@each
def test_noise_is_0_at_whole_numbers_and_smooth_across_them(dimensions):
    whole = np.floor(places(dimensions=dimensions))
    assert np.abs(noise(whole)).max() == 0
    step = np.float32(2.0**-12)
    assert np.abs(noise(whole + step) + noise(whole - step)).max() <= 1e-5
    found = np.abs(noise(places(200_000, 40_000, dimensions=dimensions)))
    assert found.max() <= 1
    assert abs(found.mean(dtype=float) - MEAN_SIZES[dimensions]) <= 0.002


def test_far_out_noise_repeats_and_beyond_whole_numbers_it_is_looked_up_between_them():
    near = np.array([[3.25, -3.25], [0.5, 0.5], [7.75, 7.75]], np.float32)
    assert np.array_equal(noise(near), noise(near + np.float32([[1e5, -1e5], [0, 0], [0, 0]])))
    far, between = np.float32([[4e6], [0.25], [0.75]]), np.float32([[0.5], [0.25], [0.75]])
    assert np.array_equal(noise(far), noise(between))


def test_offsets_are_those_of_the_twin_and_far_from_each_other():
    assert offset(2, 1).tolist() == [[pytest.approx(100 + 100 * twin_unit(2.0), abs=1e-5)]]
    for dimensions in (2, 3, 4):
        expected = [100 + 100 * twin_unit(3.0, float(axis)) for axis in range(dimensions)]
        assert offset(3, dimensions)[:, 0].tolist() == pytest.approx(expected, abs=1e-4)
    found = np.concatenate([offset(seed) for seed in range(5)], axis=1)
    assert ((found >= 100) & (found <= 200)).all()
    assert np.unique(found).size == 15
