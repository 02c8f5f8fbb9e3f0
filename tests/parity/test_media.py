"""Glass that absorbs looks as in Cycles: a ball, also one that is scaled, and a box over a floor; and what absorbs without any surface."""

import bpy
import pytest
from mathutils import Matrix

from glanz.engine import Medium
from glanz.tests.addon import blender
from glanz.tests.parity import parity
from glanz.tests.parity.test_specular import ball_over_floor

TOLERANCE = 0.01
"""Of block means; with this seed they differ by up to 0.6 %, the noise of what glass gathers."""


def absorbing(name, scale=1.0):
    """The scene of clear glass, with a medium inside of its body."""
    ball_over_floor("glass")
    body = bpy.data.objects["Sphere"]
    if name == "box":
        bpy.ops.mesh.primitive_cube_add(size=1.6, location=(0, 0, 1), rotation=(0.2, 0.3, 0.4))
        bpy.context.object.data.materials.append(body.active_material)
        bpy.data.objects.remove(body)
        body = bpy.context.object
    body.data.transform(Matrix.Scale(1 / scale, 4))
    body.scale = (scale,) * 3
    tree = bpy.data.materials["Ball"].node_tree
    node = blender.add_node(tree, "ShaderNodeVolumeAbsorption", Color=(0.9, 0.5, 0.2, 1), Density=0.7)
    output = tree.get_output_node("CYCLES")
    tree.links.new(node.outputs[0], output.inputs["Volume"])
    if name == "fog":
        tree.links.remove(output.inputs["Surface"].links[0])
        bpy.context.scene.cycles.transparent_max_bounces = 64


@pytest.mark.parametrize(("name", "scale"), [("ball", 1.0), ("ball", 0.5), ("box", 1.0), ("fog", 1.0)])
def test_glass_that_absorbs_looks_as_in_cycles(name, scale, tmp_path):
    """Means of 16 blocks within 1 %, of each channel of the picture within 0.15 %."""
    absorbing(name, scale)
    ours, theirs = (parity.pixels(engine, tmp_path) for engine in ("GLANZ", "CYCLES"))
    assert parity.difference(ours, theirs) <= TOLERANCE
    assert ours.mean(axis=(0, 1)) == pytest.approx(theirs.mean(axis=(0, 1)), rel=0.0015)


def test_the_comparison_catches_a_tenth_more_absorption(monkeypatch, tmp_path):
    absorbing("box")
    theirs = parity.pixels("CYCLES", tmp_path)
    monkeypatch.setattr("glanz.addon.export.inside.Medium", lambda absorption, priority: Medium(absorption=[1.1 * c for c in absorption]))
    ours = parity.pixels("GLANZ", tmp_path)
    assert parity.difference(ours, theirs) > TOLERANCE or ours.mean(axis=(0, 1)) != pytest.approx(theirs.mean(axis=(0, 1)), rel=0.0015)
