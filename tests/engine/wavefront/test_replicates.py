"""What replicates say of the error, from numbers alone; renders are in `tests/renders/test_standard_error.py`."""

import numpy as np
import pytest

from glanz.engine.wavefront.numbers import seed_of
from glanz.engine.wavefront.replicates import Replicates


def gathered(values, size, first=0, at_once=3):
    """`values` (C, samples, P), added in batches."""
    replicates = Replicates(len(values), values.shape[2], size)
    for start in range(0, values.shape[1], at_once):
        replicates.add(slice(0, values.shape[2]), first + start, values[:, start : start + at_once])
    return replicates


def test_the_standard_error_is_that_of_the_means_of_replicates():
    values = np.random.default_rng(1).normal(3, 1, (3, 32, 5))
    means = values.reshape(3, 4, 8, 5).mean(axis=2)
    np.testing.assert_allclose(gathered(values, 8).standard_error(), means.std(axis=1, ddof=1) / 2, rtol=1e-12)


@pytest.mark.parametrize("at_once", [1, 5, 7, 32])
def test_batches_do_not_change_a_bit(at_once):
    values = np.random.default_rng(2).normal(3, 1, (3, 32, 5))
    assert np.array_equal(gathered(values, 4, at_once=at_once).standard_error(), gathered(values, 4).standard_error())


def test_nothing_is_known_of_fewer_than_two_replicates():
    values = np.ones((1, 7, 2))
    assert np.isinf(gathered(values, 4).standard_error()).all()
    assert np.isinf(Replicates(1, 2, 4).standard_error()).all()


def test_numbers_far_from_zero_lose_no_digits():
    values = 1e8 + np.random.default_rng(3).normal(0, 1, (1, 64, 100))
    np.testing.assert_allclose(gathered(values, 4).standard_error().mean(), 1 / 8, rtol=0.05)


@pytest.mark.parametrize(("samples", "first"), [(30, 0), (32, 5), (61, 3)])
def test_replicates_that_are_not_whole_leave_the_variance_without_bias(samples, first):
    """20,000 pixels: the mean variance has a standard error of 0.6 %, so 3 % is passed by chance once in 2 million."""
    values = np.random.default_rng(4).normal(0, 1, (1, samples, 20000))
    variance = np.square(gathered(values, 4, first).standard_error()).mean()
    assert variance == pytest.approx(1 / samples, rel=0.03)


def test_seeds_of_replicates_do_not_meet_those_of_other_seeds():
    seeds = [seed_of(seed, replicate) for seed in range(-64, 192) for replicate in range(64)]
    assert len(set(seeds)) == len(seeds)
    assert seed_of(7, 0) == 7
