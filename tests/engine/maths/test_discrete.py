"""Choosing in proportion to weights (catalogue B9)."""

import dataclasses

import numpy as np
import pytest

from glanz.engine.maths import discrete
from glanz.tests import chance, helpers as h

WEIGHTS = {
    "few": [1.0, 2.0, 0.0, 4.0],
    "one": [3.0],
    "zero at the ends": [0.0, 0.0, 1.0, 1.0, 0.0, 0.0],
    "many": np.random.default_rng(1).random(500),
    "many with zeros": np.where(np.arange(100) % 3, 1.0, 0.0),
}


def check_choice(cdf, weights, choose=discrete.choose, n=200_000):
    weights = np.asarray(weights, float)
    n = chance.times(n)
    u = np.random.default_rng(chance.seeded(2)).random(n, np.float32)
    counts = np.bincount(choose(cdf, u), minlength=weights.size)
    assert counts.size == weights.size
    assert (counts[weights == 0] == 0).all()
    assert h.chi2_p(counts, n * weights / weights.sum()) > h.ALPHA


@pytest.mark.parametrize("name", WEIGHTS)
@chance.fresh
def test_choices_come_in_proportion(name):
    """chi2 of 2e5 choices; detects 1.5 % of a weight of one half."""
    check_choice(discrete.cumulative(WEIGHTS[name]), WEIGHTS[name])


def test_proportion_catches_weights_off_by_three_percent():
    with pytest.raises(AssertionError):
        check_choice(discrete.cumulative([1.0, 2.0, 0.0, 4.2]), WEIGHTS["few"])


def test_proportion_catches_a_choice_off_by_one():
    with pytest.raises(AssertionError):
        check_choice(discrete.cumulative([1.0, 2.0, 3.0]), [1.0, 2.0, 3.0], lambda cdf, u: np.minimum(discrete.choose(cdf, u) + 1, 2))


@pytest.mark.parametrize("name", WEIGHTS)
def test_probabilities_are_exactly_what_is_chosen(name):
    """Counted over a fine grid of all numbers, not sampled: 2^20 of the 2^24 float32 numbers."""
    cdf = discrete.cumulative(WEIGHTS[name])
    p = discrete.probabilities(cdf)
    assert p.sum() == pytest.approx(1, abs=1e-15)
    assert ((np.asarray(WEIGHTS[name]) > 0) == (p > 0)).all()
    u = (np.arange(2**20, dtype=np.float32)) * np.float32(2.0**-20)
    share = np.bincount(discrete.choose(cdf, u), minlength=p.size) / u.size
    assert np.abs(share - p).max() <= 2.0**-20


@pytest.mark.parametrize("large", [1e30, 1e300])
def test_the_weak_are_not_lost_beside_the_strong(large):
    cdf = discrete.cumulative([1e-30, large, 0.0])
    p = discrete.probabilities(cdf)
    assert p[0] > 0
    assert p[1] == pytest.approx(1, abs=1e-6)
    assert p[2] == 0
    u = np.array([0, 2.0**-24, 0.5, 1 - 2.0**-24], np.float32)
    assert (discrete.choose(cdf, u) <= 1).all()
    assert discrete.choose(cdf, u[:1])[0] == 0


def test_few_and_many_choices_are_made_alike(monkeypatch):
    cdf = discrete.cumulative(np.arange(1.0, 12.0))
    u = np.append(np.random.default_rng(3).random(5_000, np.float32), cdf[:-1].astype(np.float32))
    counted = discrete.choose(cdf, u)
    monkeypatch.setattr(discrete, "_FEW", 0)
    assert (discrete.choose(cdf, u) == counted).all()


GUIDED = WEIGHTS | {"one outshines the others": [1e-6] * 300 + [1.0] + [1e-6] * 300, "alike": [1.0] * 1000}


@pytest.mark.parametrize("name", GUIDED)
def test_a_guide_leads_where_a_search_ends(name):
    """At both sides of every edge, and in between; to the bit."""
    cdf = discrete.cumulative(GUIDED[name])
    edges = np.concatenate((cdf, np.nextafter(cdf, 0), [0.0], np.random.default_rng(3).random(5000)))
    u = edges[edges < 1]
    assert np.array_equal(discrete.Guide.of(cdf).choose(u), np.searchsorted(cdf, u, side="right"))


def test_a_guide_with_a_step_too_few_is_caught():
    cdf = discrete.cumulative([1.0] * 1000)
    right = discrete.Guide.of(cdf)
    u = np.random.default_rng(3).random(5000)
    assert 0 < right.steps <= 2
    assert not np.array_equal(dataclasses.replace(right, steps=right.steps - 1).choose(u), right.choose(u))


@pytest.mark.parametrize("count", [5, 500])
@pytest.mark.parametrize("choose", [discrete.choose, lambda cdf, u: discrete.Guide.of(cdf).choose(u)], ids=["search", "guide"])
def test_what_is_no_number_chooses_one_of_them_all_the_same(choose, count):
    """Found by chance: it chose one beyond the last. The second weights are too uneven for a guide to be of help."""
    for weights in (np.ones(count), 2.0 ** -np.arange(count)):
        with np.errstate(invalid="ignore"):
            assert 0 <= choose(discrete.cumulative(weights), np.array([np.nan]))[0] < count
