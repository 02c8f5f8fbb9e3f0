"""Paper and leaves look as in Cycles: a card that light shines through, under a lamp and a bright world."""

import bpy
import pytest

from glanz.engine.bsdfs.lambert_transmission import LambertTransmission
from glanz.tests.addon import blender
from glanz.tests.parity import parity

SAMPLES = 1024
TOLERANCE = 0.01
"""Of block means."""


def card_over_floor(share):
    """A tilted card between camera and lamp: the share of Translucent in a mix with Diffuse."""
    camera = blender.add_camera(location=(0, -6, 2), width=64, height=64)
    camera.rotation_euler = (1.3, 0, 0)
    blender.set_world((0.3, 0.35, 0.4))
    blender.add_plane(size=8).data.materials.append(blender.new_material("Floor", "ShaderNodeBsdfDiffuse", Color=(0.6, 0.5, 0.4, 1)))
    card = bpy.data.materials.new("Card")
    tree = blender.new_nodes(card)
    mix = blender.add_node(tree, "ShaderNodeMixShader", Fac=share)
    for i, (kind, colour) in enumerate((("ShaderNodeBsdfDiffuse", (0.7, 0.6, 0.5, 1)), ("ShaderNodeBsdfTranslucent", (0.5, 0.8, 0.3, 1)))):
        tree.links.new(blender.add_node(tree, kind, Color=colour).outputs[0], mix.inputs[1 + i])
    tree.links.new(mix.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    plane = blender.add_plane("Card", 2, (0, 0, 1.2))
    plane.rotation_euler = (1.2, 0, 0.2)
    plane.data.materials.append(card)
    lamp = bpy.data.lights.new("Lamp", "AREA")
    lamp.size, lamp.energy = 1, 200
    blender.link("Lamp", lamp, (0.5, 2.5, 3)).rotation_euler = (-0.7, 0, 0)
    parity.be_exact(SAMPLES, 6)
    cycles = bpy.context.scene.cycles
    cycles.glossy_bounces = cycles.transmission_bounces = 6


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_a_translucent_card_looks_as_in_cycles(share, tmp_path):
    """Means of 16 blocks within 1 %, of the picture within 0.2 %."""
    card_over_floor(share)
    ours, theirs = (parity.pixels(engine, tmp_path) for engine in ("GLANZ", "CYCLES"))
    assert parity.difference(ours, theirs) <= TOLERANCE
    assert abs(ours.mean() / theirs.mean() - 1) <= 0.002


def test_the_comparison_catches_a_card_of_another_transmittance(monkeypatch, tmp_path):
    """The mutant lets 3 % less pass."""
    card_over_floor(1.0)
    monkeypatch.setattr(LambertTransmission, "row", lambda self: {"transmittance": tuple(0.97 * c for c in self.transmittance)})
    ours, theirs = (parity.pixels(engine, tmp_path) for engine in ("GLANZ", "CYCLES"))
    assert parity.difference(ours, theirs) > TOLERANCE
