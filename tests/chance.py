"""Tests of laws on examples that are drawn: a few, the same each time; or, for GLANZ_SEED, many that are new.

`make test-thorough` runs the second kind, marked `thorough`, with a seed that it prints. Examples of two kinds: those that Hypothesis
draws, of `law`, and random numbers of tests that are statistics themselves, of `fresh`.
"""

import functools
import os

import pytest
from hypothesis import HealthCheck, seed, settings

SEED = os.environ.get("GLANZ_SEED")
"""The seed of a thorough run, a whole number; None: tests are quick, and draw what they have always drawn."""
MORE = 10
"""So many times as many random numbers have statistical tests in a thorough run: three times smaller errors are noticed."""
_is_fresh = False


def law(quick, thorough):
    """Decorates a test beside `given`: so many examples are drawn in a quick and in a thorough run."""

    def decorated(test):
        test = pytest.mark.thorough(test)
        common = {"deadline": None, "database": None, "suppress_health_check": list(HealthCheck)}
        if SEED is None:
            return settings(max_examples=quick, derandomize=True, **common)(test)
        return seed(int(SEED))(settings(max_examples=thorough, print_blob=True, **common)(test))

    return decorated


def fresh(test):
    """Decorates a test that judges random numbers at a level of false alarms: in a thorough run they are others, and MORE times as many.

    One false alarm in a million is what each comparison has; a test that fails is run again with another GLANZ_SEED, and counts if it
    fails once more. Numbers are others where they come from `helpers` or of seeds that went through `seeded`, and more where
    their count went through `times`, as that of the samples of `helpers.settings`.
    """

    @functools.wraps(test)
    def wrapped(*args, **kwargs):
        global _is_fresh
        before, _is_fresh = _is_fresh, SEED is not None
        try:
            return test(*args, **kwargs)
        finally:
            _is_fresh = before

    return pytest.mark.thorough(wrapped)


def seeded(number):
    """A seed in the place of the whole number `number`: itself, or within a `fresh` test of a thorough run another one."""
    return number + int(SEED) * 2**20 if _is_fresh else number


def times(count):
    """How many random numbers there are where a quick run has `count`."""
    return MORE * count if _is_fresh else count
