"""The judges of the statistical tests are judged: honest where nothing is wrong, severe where something is."""

import numpy as np
import pytest
from scipy import stats

from glanz.tests import helpers as h


def test_chi2_is_uniform_where_nothing_is_wrong():
    """400 p-values of true expectations: Kolmogorov-Smirnov against the uniform distribution; bins of few are pooled."""
    rng = np.random.default_rng(1)
    for expected in (np.full(64, 50.0), np.append(np.geomspace(1e-3, 400, 80), 0.0)):
        p = [h.chi2_p(rng.poisson(expected), expected) for _ in range(400)]
        assert stats.kstest(p, "uniform").pvalue > 1e-3
        assert min(p) > h.ALPHA


@pytest.mark.parametrize("bins", [64, 1024])
def test_chi2_sees_a_tenth_too_much_in_half_of_the_bins(bins):
    rng = np.random.default_rng(2)
    expected = np.full(bins, 400.0)
    biased = expected * np.where(np.arange(bins) % 2, 1.1, 0.9)
    assert h.chi2_p(rng.poisson(biased), expected) < h.ALPHA


def test_chi2_sees_counts_where_none_can_be():
    expected = np.append(np.full(10, 100.0), np.zeros(5))
    observed = np.append(np.full(10, 100), [0, 0, 3, 0, 0])
    assert h.chi2_p(observed, expected) < h.ALPHA


@pytest.mark.parametrize("n", [2, 64, 10_000])
def test_means_are_accepted_where_they_are_true_and_refused_where_they_are_not(n):
    rng = np.random.default_rng(3)
    for _ in range(200):
        assert h.mean_is(rng.standard_normal(n) + 5, 5)
    if n > 2:
        assert not h.mean_is(rng.standard_normal(n) + 5, 5 + 12 / np.sqrt(n))


def test_agreement_is_found_where_it_is_and_only_there():
    rng = np.random.default_rng(4)
    for _ in range(200):
        assert h.means_agree(rng.standard_normal(50), 10 * rng.standard_normal(400))
    assert not h.means_agree(rng.standard_normal(500), rng.standard_normal(500) + 0.5)
    assert h.means_agree(np.full(9, 0.1), np.full(9, 0.1))
    assert not h.means_agree(np.full(9, 0.1), np.full(9, 0.2))
    # Two renderers of black are not seen to agree.
    assert not h.means_agree(np.zeros(9), np.zeros(9))


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_nothing_that_is_not_finite_is_ever_accepted(bad):
    """`assert not error > tolerance` would let NaN pass."""
    values = np.ones(100)
    values[3] = bad
    with np.errstate(invalid="ignore"):
        assert not h.mean_is(values, 1.0)
        assert not h.means_agree(values, np.ones(100))
        assert not h.means_agree(np.full(100, bad), np.ones(100))


def test_bits_are_compared_as_bits():
    assert h.same_bits(np.array([np.nan, -0.0]), np.array([np.nan, -0.0]))
    assert not h.same_bits(np.array([0.0]), np.array([-0.0]))
    assert not h.same_bits(np.array([1.0]), np.array([1.0], np.float32))
    assert not h.same_bits(np.zeros((1, 2)), np.zeros((2, 1)))
