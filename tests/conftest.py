"""Shared by all tests. Helpers are imported by name: `from glanz.tests import helpers`."""

import pytest

from glanz.tests import chance

# Assertions in helpers say as much when they fail as those in tests.
pytest.register_assert_rewrite("glanz.tests.helpers", "glanz.tests.bsdf_laws")


def pytest_report_header():
    if chance.SEED is not None:
        return f"GLANZ_SEED={chance.SEED} draws the same examples again"
    return None
