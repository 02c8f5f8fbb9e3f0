"""Tests of laws on examples that Hypothesis draws: a few, the same each time; or, for GLANZ_SEED, many that are new.

`make test-thorough` runs the second kind, marked `thorough`, with a seed that it prints.
"""

import os

import pytest
from hypothesis import HealthCheck, seed, settings

SEED = os.environ.get("GLANZ_SEED")
"""The seed of a thorough run, a whole number; None: tests are quick, and draw what they have always drawn."""


def law(quick, thorough):
    """Decorates a test beside `given`: so many examples are drawn in a quick and in a thorough run."""

    def decorated(test):
        test = pytest.mark.thorough(test)
        common = {"deadline": None, "database": None, "suppress_health_check": list(HealthCheck)}
        if SEED is None:
            return settings(max_examples=quick, derandomize=True, **common)(test)
        return seed(int(SEED))(settings(max_examples=thorough, print_blob=True, **common)(test))

    return decorated
