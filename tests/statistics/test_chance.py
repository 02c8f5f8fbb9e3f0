"""Thorough runs draw other random numbers, and more of them, and quick ones always the same."""

import numpy as np
import pytest

from glanz.tests import chance, helpers as h


@chance.fresh
def drawn():
    """What a fresh test sees: numbers, the settings of a picture, a count."""
    return h.uniform(1, 5), h.settings(samples=4, seed=3), chance.times(7)


def test_quick_runs_draw_what_they_have_always_drawn(monkeypatch):
    monkeypatch.setattr(chance, "SEED", None)
    numbers, settings, count = drawn()
    assert h.same_bits(numbers, np.random.default_rng(1).random((2, 5)))
    assert (settings.seed, settings.samples, count) == (3, 4, 7)


def test_thorough_runs_draw_others_and_more_of_them_by_the_seed_that_they_print(monkeypatch):
    monkeypatch.setattr(chance, "SEED", None)
    quick, *_ = drawn()
    found = []
    for seed in ("7", "8", "7"):
        monkeypatch.setattr(chance, "SEED", seed)
        numbers, settings, count = drawn()
        assert not (numbers == quick).any()
        assert (settings.samples, count) == (4 * chance.MORE, 7 * chance.MORE)
        found.append((numbers.tolist(), settings.seed))
    assert found[0] == found[2] != found[1]
    assert found[0][1] != found[1][1]


def test_tests_that_are_not_fresh_keep_their_numbers_in_thorough_runs(monkeypatch):
    """Also after one that is has failed."""
    monkeypatch.setattr(chance, "SEED", "7")

    @chance.fresh
    def failing():
        raise ValueError("once")

    with pytest.raises(ValueError, match="once"):
        failing()
    assert h.same_bits(h.uniform(1, 5), np.random.default_rng(1).random((2, 5)))
    assert h.settings(samples=4).samples == 4
