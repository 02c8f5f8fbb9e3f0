"""Noise is that of its scalar twin in float64; that it is Blender's is seen by the parity tests."""

import math

import numpy as np
import pytest

from glanz.engine.maths import perlin
from glanz.engine.maths.perlin import fractal, jenkins, noise, offset
from glanz.tests import helpers as h

MASK = 0xFFFFFFFF


def twin_hash(*words):
    """Jenkins' lookup3, final part, on Python integers."""

    def rot(x, k):
        return (x << k | x >> 32 - k) & MASK

    a, b, c = ((0xDEADBEEF + 4 * len(words) + 13 + w) & MASK for w in (*words, 0)[:3])
    c ^= b
    c = (c - rot(b, 14)) & MASK
    a ^= c
    a = (a - rot(c, 11)) & MASK
    b ^= a
    b = (b - rot(a, 25)) & MASK
    c ^= b
    c = (c - rot(b, 16)) & MASK
    a ^= c
    a = (a - rot(c, 4)) & MASK
    b ^= a
    b = (b - rot(a, 14)) & MASK
    c ^= b
    return (c - rot(b, 24)) & MASK


def twin_noise(x, y, z):
    """Perlin 2002 in float64: gradients to the middles of the cube's edges, quintic fade."""
    cell = [math.floor(c) for c in (x, y, z)]
    f = [c - i for c, i in zip((x, y, z), cell)]
    fade = [t**3 * (t * (6 * t - 15) + 10) for t in f]
    total = 0.0
    for corner in np.ndindex(2, 2, 2):
        kind = twin_hash(*((i + s) & MASK for i, s in zip(cell, corner))) & 15
        dx, dy, dz = (t - s for t, s in zip(f, corner))
        first = dx if kind < 8 else dy
        second = dy if kind < 4 else dx if kind in (12, 14) else dz
        weight = math.prod(w if s else 1 - w for w, s in zip(fade, corner))
        total += weight * ((-first if kind & 1 else first) + (-second if kind & 2 else second))
    return 0.982 * total


def twin_fractal(p, detail, roughness, lacunarity, is_normalized):
    def octaves(count):
        terms = [(roughness**i, twin_noise(*(lacunarity**i * c for c in p))) for i in range(count)]
        total, most = sum(a * n for a, n in terms), sum(a for a, _ in terms)
        return 0.5 * total / most + 0.5 if is_normalized else total

    whole = math.floor(detail)
    coarse, fine = octaves(whole + 1), octaves(whole + 2)
    return coarse + (detail - whole) * (fine - coarse)


def places(n=200, scale=20.0):
    return ((np.random.default_rng(5).random((3, n)) - 0.5) * scale).astype(np.float32)


def test_hashes_are_those_of_the_twin():
    words = np.random.default_rng(1).integers(0, 2**32, (3, 50), np.uint32)
    for count in (2, 3):
        expected = [twin_hash(*map(int, column)) for column in words[:count].T]
        assert jenkins(*words[:count]).tolist() == expected


def test_noise_is_that_of_the_twin():
    p = places()
    expected = [twin_noise(*map(float, q)) for q in p.T]
    assert np.abs(noise(p) - expected).max() <= 1e-5
    assert noise(p).dtype == np.float32


def test_the_twin_catches_another_gradient(monkeypatch):
    products = perlin._products
    monkeypatch.setattr(perlin, "_products", lambda hashes, x, y, z: products(hashes ^ np.uint32(1), x, y, z))
    with pytest.raises(AssertionError):
        test_noise_is_that_of_the_twin()


@pytest.mark.parametrize("detail", [0.0, 1.0, 2.0, 2.5, 3.75])
@pytest.mark.parametrize("is_normalized", [True, False])
def test_octaves_are_those_of_the_twin(detail, is_normalized):
    p = places(60)
    expected = [twin_fractal(tuple(map(float, q)), detail, 0.6, 2.3, is_normalized) for q in p.T]
    assert np.abs(fractal(p, None, detail, 0.6, 2.3, is_normalized) - expected).max() <= 3e-4


def test_noise_is_0_at_whole_numbers_and_smooth_across_them():
    whole = np.floor(places())
    assert np.abs(noise(whole)).max() == 0
    step = np.float32(2.0**-12)
    assert np.abs(noise(whole + step) + noise(whole - step)).max() <= 3e-6
    assert np.abs(noise(places(20_000))).max() <= 1


def test_octaves_finer_than_the_footprint_are_left_out():
    """So what is left is the noise of fewer octaves, and of a footprint wider than a cell the mean."""
    p = places()
    wide, narrow = np.full(p.shape[1], np.float32(0.5)), np.zeros(p.shape[1], np.float32)
    assert h.same_bits(fractal(p, wide, 4, 0.5, 2.0, True), np.full(p.shape[1], np.float32(0.5)))
    assert h.same_bits(fractal(p, narrow, 4, 0.5, 2.0, True), fractal(p, None, 4, 0.5, 2.0, True))


def test_offsets_are_far_from_each_other():
    found = np.concatenate([offset(seed) for seed in range(5)], axis=1)
    assert ((found >= 100) & (found <= 200)).all()
    assert np.unique(found).size == 15
