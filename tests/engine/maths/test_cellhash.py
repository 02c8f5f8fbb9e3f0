"""Hashes agree to the bit with twins on Python's integers."""

import struct

import numpy as np
import pytest

from glanz.engine.maths import cellhash
from glanz.engine.maths.cellhash import jenkins, pcg, unit, unit3, whole
from glanz.tests import helpers as h

MASK = 0xFFFFFFFF


def rot(x, k):
    return (x << k | x >> 32 - k) & MASK


def twin_hash(*words):
    """Jenkins' lookup3: the part that mixes where there are four words, then the final part."""
    a, b, c = ((0xDEADBEEF + 4 * len(words) + 13 + w) & MASK for w in (*words, 0, 0)[:3])
    if len(words) == 4:
        a = ((a - c) & MASK) ^ rot(c, 4)
        c = (c + b) & MASK
        b = ((b - a) & MASK) ^ rot(a, 6)
        a = (a + c) & MASK
        c = ((c - b) & MASK) ^ rot(b, 8)
        b = (b + a) & MASK
        a = ((a - c) & MASK) ^ rot(c, 16)
        c = (c + b) & MASK
        b = ((b - a) & MASK) ^ rot(a, 19)
        a = (a + c) & MASK
        c = ((c - b) & MASK) ^ rot(b, 4)
        b = (b + a) & MASK
        a = (a + words[3]) & MASK
    c = ((c ^ b) - rot(b, 14)) & MASK
    a = ((a ^ c) - rot(c, 11)) & MASK
    b = ((b ^ a) - rot(a, 25)) & MASK
    c = ((c ^ b) - rot(b, 16)) & MASK
    a = ((a ^ c) - rot(c, 4)) & MASK
    b = ((b ^ a) - rot(a, 14)) & MASK
    return ((c ^ b) - rot(b, 24)) & MASK


def twin_unit(*numbers):
    """float32 in [0, 1] of the bits of numbers."""
    words = [struct.unpack("<I", struct.pack("<f", x))[0] for x in numbers]
    return float(np.float32(twin_hash(*words))) * 2.0**-32


def twin_pcg(*cell):
    """Jarzynski and Olano 2020, pcg3d and pcg4d; of two coordinates likewise; on signed integers."""
    v = [(c * 1664525 + 1013904223) & MASK for c in cell]
    steps = {
        2: [(0, lambda v: v[1] * 1664525), (1, lambda v: v[0] * 1664525)],
        3: [(0, lambda v: v[1] * v[2]), (1, lambda v: v[2] * v[0]), (2, lambda v: v[0] * v[1])],
        4: [(0, lambda v: v[1] * v[3]), (1, lambda v: v[2] * v[0]), (2, lambda v: v[0] * v[1]), (3, lambda v: v[1] * v[2])],
    }[len(v)]
    for part in range(2):
        for row, product in steps:
            v[row] = (v[row] + product(v)) & MASK
        if part == 0:
            v = [(c ^ (c - (c >> 31 << 32) >> 16)) & MASK for c in v]
    return [float(np.float32(c & 0x7FFFFFFF)) * 2.0**-31 for c in v]


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_words_hash_as_the_twins_do(count):
    words = np.random.default_rng(1).integers(0, 2**32, (count, 50), np.uint32)
    assert jenkins(*words).tolist() == [twin_hash(*map(int, column)) for column in words.T]


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_numbers_hash_by_their_bits(count):
    numbers = (np.random.default_rng(2).standard_normal((count, 50)) * 100).astype(np.float32)
    found = unit(*numbers)
    assert found.dtype == np.float32
    assert found.tolist() == [twin_unit(*map(float, column)) for column in numbers.T]
    assert h.same_bits(unit3(*numbers)[0].copy(), found)
    assert np.abs(unit3(*numbers).mean(axis=1) - 0.5).max() <= 0.2


@pytest.mark.parametrize("count", [2, 3, 4])
def test_cells_hash_as_the_twins_do(count):
    cells = np.random.default_rng(3).integers(-(2**31), 2**31, (count, 50)).astype(np.int32)
    cells[:, :2] = [[0, -1]] * count
    before = cells.copy()
    assert pcg(cells).T.tolist() == [twin_pcg(*map(int, column)) for column in cells.T]
    assert np.array_equal(cells, before)


@pytest.mark.parametrize("mutant", ["_FINAL", "_MIX"])
def test_hashes_catch_a_rotation_by_another_bit(mutant, monkeypatch):
    (*names, bits), *others = getattr(cellhash, mutant)
    monkeypatch.setattr(cellhash, mutant, ((*names, bits + 1), *others))
    with pytest.raises(AssertionError):
        test_words_hash_as_the_twins_do(4)


def test_hashes_catch_steps_in_another_order(monkeypatch):
    steps = dict(cellhash._PCG_STEPS)
    steps[3] = steps[3][::-1]
    monkeypatch.setattr(cellhash, "_PCG_STEPS", steps)
    with pytest.raises(AssertionError):
        test_cells_hash_as_the_twins_do(3)


def test_whole_numbers_beyond_integers_are_the_least():
    x = np.array([-3.0, 0.0, 2.0**30, 2.0**31, -(2.0**31), 1e30, -np.inf, np.nan], np.float32)
    least = -(2**31)
    assert whole(x).tolist() == [-3, 0, 2**30, least, least, least, least, least]
