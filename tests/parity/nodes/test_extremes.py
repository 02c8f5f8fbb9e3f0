"""Nodes that compute are Cycles' where there is hardly a result: 0 / 0, roots of negative numbers, empty ranges, huge hues."""

import bpy
import numpy as np
import pytest

from glanz.engine.maths import arithmetic
from glanz.tests.parity.nodes import extremes
from glanz.tests.parity.nodes.cases import cases
from glanz.tests.parity.nodes.grid import shares

BAR = 0.99


@pytest.mark.parametrize("kind", [f"ShaderNode{name}" for name in extremes.KINDS.split()])
def test_a_node_bears_what_cycles_bears(kind, tmp_path):
    if kind not in extremes.known():
        pytest.skip("not in this version of Blender")
    found = shares(cases(kind), tmp_path, build=extremes.build)
    low = {f"{c.output}: {c.mode} ({c.seed})": round(share, 4) for c, share in found.items() if share < BAR and not _excuse(c)}
    assert found and not low, low


@pytest.mark.parametrize("name", ["ramps", "RGBCurve", "VectorCurve", "FloatCurve"])
def test_ramps_and_curves_are_those_of_cycles_in_every_mode(name, tmp_path):
    found = shares(extremes.inner_modes()[name], tmp_path, build=extremes.build)
    assert not {f"{c.output}: {c.mode} ({c.seed})": round(share, 4) for c, share in found.items() if share < BAR}


def _excuse(case):
    """Blender 4.2 leaves hues that are turned below 0 there, where there are no colours; Glanz turns them on."""
    return bpy.app.version < (4, 5) and case.kind == "ShaderNodeHueSaturation"


@pytest.mark.parametrize(("operation", "wrong"), [("divide", lambda a, b: a / b), ("modulo", lambda a, b: a % b), ("sign", np.abs)])
def test_extremes_catch_operations_that_are_others(operation, wrong, tmp_path, monkeypatch):
    monkeypatch.setitem(arithmetic.NUMBERS, operation, wrong)
    mode = [c for c in cases("ShaderNodeMath") if c.properties.get("operation") == operation.upper()]
    assert max(shares(mode, tmp_path, build=extremes.build).values()) < BAR
