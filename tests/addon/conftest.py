"""Blender runs inside the test process; every test starts from an empty file with Glanz registered."""

import importlib.util
import os
import sys

import pytest

_result = {}


class _WithoutBlender(pytest.Module):
    """A test module that cannot even be imported."""

    def collect(self):
        pytest.skip("Blender as a Python module (bpy) is not installed", allow_module_level=True)


def pytest_pycollect_makemodule(module_path, parent):
    return None if importlib.util.find_spec("bpy") else _WithoutBlender.from_parent(parent, path=module_path)


@pytest.fixture(autouse=True)
def empty_file():
    """A new file: one scene, nothing in it, Glanz as its engine."""
    import bpy

    import glanz

    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    glanz.register()
    bpy.context.scene.render.engine = "GLANZ"


def pytest_sessionfinish(session, exitstatus):
    _result["status"] = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config):
    """After a render, bpy 4.2 crashes and bpy 4.5 hangs when Python ends: leave before that."""
    bpy = sys.modules.get("bpy")
    if bpy is not None and bpy.app.version < (5, 0) and "status" in _result:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(_result["status"])
