"""What replicates say of the error, from numbers alone; renders are in `tests/renders/test_standard_error.py`."""

import numpy as np
import pytest

from glanz.engine.wavefront.numbers import layout, seed_of
from glanz.engine.wavefront.replicates import Replicates
from glanz.tests import helpers as h


def gathered(values, sizes, first=0, at_once=3):
    """`values` (C, samples, P), added in batches."""
    replicates = Replicates(len(values), values.shape[2], sizes)
    for start in range(0, values.shape[1], at_once):
        replicates.add(slice(0, values.shape[2]), first + start, values[:, start : start + at_once])
    return replicates


def normal(seed, *shape, mean=0.0):
    return np.random.default_rng(seed).normal(mean, 1, shape)


def test_the_standard_error_is_that_of_the_means_of_replicates():
    values = normal(1, 3, 32, 5, mean=3)
    means = values.reshape(3, 4, 8, 5).mean(axis=2)
    found = gathered(values, (8,) * 4)
    np.testing.assert_allclose(found.standard_error(), means.std(axis=1, ddof=1) / 2, rtol=1e-12)
    np.testing.assert_allclose(found.freedom(), 3, rtol=1e-12)


@pytest.mark.parametrize("at_once", [1, 5, 7, 32])
def test_batches_do_not_change_a_bit(at_once):
    values, sizes = normal(2, 3, 32, 5, mean=3), (4, 4, 8, 8, 8)
    assert np.array_equal(gathered(values, sizes, at_once=at_once).standard_error(), gathered(values, sizes).standard_error())


def test_nothing_is_known_of_fewer_than_two_replicates():
    values = np.ones((1, 7, 2))
    for found in (gathered(values, (4, 4)), Replicates(1, 2, (4, 4)), gathered(values, (2, 5))):
        assert np.isinf(found.standard_error()).all()
        assert (found.freedom() == 0).all()


def test_numbers_far_from_zero_lose_no_digits():
    values = 1e8 + normal(3, 1, 64, 100)
    np.testing.assert_allclose(gathered(values, (4,) * 16).standard_error().mean(), 1 / 8, rtol=0.05)


@pytest.mark.parametrize(("samples", "first"), [(30, 0), (32, 5), (61, 3)])
def test_replicates_that_are_not_whole_leave_the_variance_without_bias(samples, first):
    """20,000 pixels: the mean variance has a standard error of 0.6 %, so 3 % is passed by chance once in 2 million."""
    variance = np.square(gathered(normal(4, 1, samples, 20000), (4,) * 20, first).standard_error()).mean()
    assert variance == pytest.approx(1 / samples, rel=0.03)


@pytest.mark.parametrize("samples", [8, 16, 24, 32, 48, 64, 80, 112])
def test_replicates_of_growing_sizes_leave_the_variance_without_bias(samples):
    """Larger ones, more even, have less variance per sample: here as their size^-2, where equal weights would be off by half.

    Each replicate is a constant in itself. Where the last is the only one of its size it counts as noisy as those before.
    """
    sizes = (4,) * 4 + (8,) * 4 + (16,) * 4
    means = [normal((5, i), 1, 1, 20000) / size for i, size in enumerate(sizes)]
    values = np.concatenate([np.broadcast_to(mean, (1, size, 20000)) for mean, size in zip(means, sizes, strict=True)], axis=1)[:, :samples]
    stated = np.square(gathered(values, sizes).standard_error()).mean()
    true = values.mean(axis=1).var()
    # In closed form 1.2 times too much where one is alone.
    assert stated == pytest.approx(true * (1.2 if samples in (24, 64) else 1.0), rel=0.06)


def test_a_layout_says_where_samples_are():
    found = layout((4, 4, 8, 8, 3))
    np.testing.assert_array_equal(found.edges, (8, 24))
    replicate, number = found.of(np.arange(27))
    np.testing.assert_array_equal(replicate, np.repeat(range(5), (4, 4, 8, 8, 3)))
    np.testing.assert_array_equal(number, [*range(4), *range(4), *range(8), *range(8), *range(3)])
    assert [found.size_at(sample) for sample in (0, 7, 8, 24, 26)] == [4, 4, 8, 3, 3]


def test_replicates_grow_with_the_samples_where_a_picture_may_end_any_time():
    """A fifth to an eighth of all samples so far, but for the first; all samples are in one."""
    sizes = h.settings(samples=100_000, error_target=0.01).replicate_sizes
    assert sum(sizes) == 100_000
    before = np.cumsum(sizes)[:-1]
    share = np.array(sizes[1:-1]) / (before[:-1] + sizes[1:-1])
    assert (share[7:] >= 1 / 8).all()
    assert (share[7:] <= 1 / 5).all()
    assert h.settings(samples=10, replicates=4).replicate_sizes == (3, 3, 3, 1)
    assert h.settings(samples=10).replicate_sizes == (10,)
    assert h.settings(samples=1, error_target=0.01).replicate_sizes == (1,)


def test_seeds_of_replicates_do_not_meet_those_of_other_seeds():
    seeds = [seed_of(seed, replicate) for seed in range(-64, 192) for replicate in range(64)]
    assert len(set(seeds)) == len(seeds)
    assert seed_of(7, 0) == 7
