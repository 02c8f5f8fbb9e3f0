"""Radial Tiling with whole and broken numbers of sides, sharp, rounded and round, which random inputs never are."""

import itertools
from dataclasses import replace

import bpy
import numpy as np
import pytest

from glanz.engine.maths import tiling
from glanz.tests.parity.nodes import cases, grid

KIND = "ShaderNodeRadialTiling"
SIDES, ROUNDNESS = (1.0, 2.0, 2.4, 3.0, 4.01, 5.0, 5.7, 12.0), (0.0, 0.1, 0.6, 1.0)
OUTPUTS = "Segment Coordinates", "Segment ID", "Segment Width", "Segment Rotation"

pytestmark = pytest.mark.skipif(bpy.app.version < (5, 0), reason="not in this version of Blender")


def modes(output):
    """Of two sides that are a little round Cycles computes the tangent of 90 degrees as rounded, some -10^7."""
    every = itertools.product((False, True), SIDES, ROUNDNESS)
    return [cases.Case(KIND, output, 3, {"normalize": n, "Sides": s, "Roundness": r}) for n, s, r in every if s > 2 or r in (0, 1)]


def build(tree, case):
    node = tree.nodes.new(KIND)
    for name in ("Sides", "Roundness"):
        node.inputs[name].default_value = case.properties[name]
    node.normalize = case.properties["normalize"]
    tree.links.new(cases._places(tree, np.random.default_rng(case.seed), "VECTOR", -1.5, 1.5), node.inputs["Vector"])
    return next(s for s in node.outputs if s.identifier == case.output)


@pytest.mark.parametrize("output", OUTPUTS)
def test_tiles_are_those_of_cycles(output, tmp_path):
    found = grid.shares(modes(output), tmp_path, build=build)
    assert not {replace(c, kind="").mode: round(share, 3) for c, share in found.items() if share < 0.99}


def test_a_tiling_that_nothing_feeds_is_that_of_its_own_vector(tmp_path):
    """Which has but two numbers."""

    def unfed(tree, case):
        node = tree.nodes.new(KIND)
        node.inputs["Vector"].default_value = (0.3, -0.9)
        return next(s for s in node.outputs if s.identifier == case.output)

    found = grid.shares([cases.Case(KIND, output, 1, {}) for output in OUTPUTS], tmp_path, build=unfed)
    assert set(found.values()) == {1.0}


def test_the_comparison_catches_corners_that_end_elsewhere(tmp_path, monkeypatch):
    monkeypatch.setattr(tiling, "_bend", lambda half, roundness: roundness * half)
    with pytest.raises(AssertionError):
        test_tiles_are_those_of_cycles("Segment Coordinates", tmp_path)
