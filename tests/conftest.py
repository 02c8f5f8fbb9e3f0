"""Shared by all tests. Helpers are imported by name: `from glanz.tests import helpers`."""

import pytest

# Assertions in helpers say as much when they fail as those in tests.
pytest.register_assert_rewrite("glanz.tests.helpers", "glanz.tests.bsdf_laws")
