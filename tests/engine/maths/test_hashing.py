"""Hashes and permutations of integers: what all randomness is made of."""

import numpy as np
import pytest

from glanz.engine.maths import hashing
from glanz.tests import helpers as h


def test_mixing_loses_nothing():
    """A bijection: 2^20 consecutive and 2^20 spread integers keep apart."""
    for x in (np.arange(2**20, dtype=np.uint32), np.arange(2**20, dtype=np.uint32) << np.uint32(12)):
        assert np.unique(hashing.mix(x)).size == x.size


def test_mixing_one_integer_is_mixing_an_array_of_it():
    for x in (0, 1, 12345, 2**31 - 1, 2**32 - 1, -1, 2**40 + 7):
        assert hashing.mix_int(x) == hashing.mix(np.array([x & 0xFFFFFFFF], np.uint32))[0]


def test_one_bit_in_turns_half_of_the_bits_out():
    """Avalanche: each of 32 x 32 pairs of bits within 0.5 +- 0.05."""
    x = np.random.default_rng(1).integers(0, 2**32, 20_000, dtype=np.uint32)
    for bit in range(32):
        changed = hashing.mix(x) ^ hashing.mix(x ^ np.uint32(1 << bit))
        flips = np.unpackbits(changed.view(np.uint8)).reshape(-1, 32).mean(axis=0)
        assert np.abs(flips - 0.5).max() <= 0.05, bit


def test_unit_numbers_never_reach_one():
    u = hashing.to_unit(np.array([0, 255, 256, 2**32 - 1], np.uint32))
    assert u.dtype == np.float32
    assert u.tolist() == [0, 0, 2.0**-24, 1 - 2.0**-24]


@pytest.mark.parametrize("length", [1, 2, 3, 5, 16, 17, 1000, 1024, 1025, 4096])
def test_a_permutation_has_every_place_once(length):
    index = np.arange(length, dtype=np.uint32)
    for key in (0, 1, 0xDEADBEEF, 2**32 - 1):
        places = hashing.permute(index, length, np.full(length, key, np.uint32))
        assert (np.sort(places) == index).all()


def check_places_are_equally_likely(permute, length=17):
    keys = hashing.mix(np.arange(100_000, dtype=np.uint32))
    for index in (0, 7, length - 1):
        places = permute(np.full(keys.size, index, np.uint32), length, keys)
        counts = np.bincount(places, minlength=length)
        assert h.chi2_p(counts, np.full(length, keys.size / length)) > h.ALPHA


def check_pairs_are_equally_likely(permute, length=5):
    """Every ordered pair of places for two indices."""
    keys = hashing.mix(np.arange(100_000, dtype=np.uint32) ^ np.uint32(77))
    a, b = (permute(np.full(keys.size, i, np.uint32), length, keys) for i in (0, 3))
    counts = np.bincount(a * length + b, minlength=length**2).reshape(length, length)
    assert (np.diag(counts) == 0).all()
    off = ~np.eye(length, dtype=bool)
    share = counts[off] / keys.size * (length * (length - 1))
    # The permutations come from a table of 256: pairs are as likely as that many draws allow.
    assert np.abs(share - 1).max() <= 5 * np.sqrt(length * (length - 1) / 256)


def test_every_place_of_a_permutation_is_equally_likely():
    """Detects 3 % of a place's share."""
    check_places_are_equally_likely(hashing.permute)
    check_places_are_equally_likely(hashing.permute, 1500)
    check_pairs_are_equally_likely(hashing.permute)


def test_likelihood_catches_permutations_that_only_rotate_or_do_nothing():
    with pytest.raises(AssertionError):
        check_places_are_equally_likely(lambda index, length, key: index)
    with pytest.raises(AssertionError):
        check_pairs_are_equally_likely(lambda index, length, key: (index + key % np.uint32(length)) % np.uint32(length))
