"""Blender runs inside the test process, as in the add-on's tests."""

from glanz.tests.addon.conftest import empty_file, pytest_pycollect_makemodule, pytest_sessionfinish, pytest_unconfigure

__all__ = ["empty_file", "pytest_pycollect_makemodule", "pytest_sessionfinish", "pytest_unconfigure"]
