"""Shared by all tests. Helpers are imported by name: `from glanz.tests import helpers`."""

import gc

import pytest

from glanz.tests import chance

# Assertions in helpers say as much when they fail as those in tests.
pytest.register_assert_rewrite("glanz.tests.helpers", "glanz.tests.bsdf_laws")


def pytest_report_header():
    if chance.SEED is not None:
        return f"GLANZ_SEED={chance.SEED} draws the same examples again"
    return None


def pytest_collection_finish():
    """A million objects that live as long as the tests: no collection of garbage is to look at them again."""
    gc.collect()
    gc.freeze()
