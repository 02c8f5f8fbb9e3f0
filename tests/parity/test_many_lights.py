"""Forty lamps above a dull floor and above a mirror: as bright, and as often mirrored, as in Cycles."""

import math

import bpy
import pytest
from mathutils import Euler

from glanz.tests.addon import blender
from glanz.tests.parity import parity

MOST = 0.01


def hall(shader, roughness=None):
    """Rows of panels that face down and of bulbs, of five brightnesses, above one floor."""
    inputs = {} if roughness is None else {"Roughness": roughness}
    floor = blender.add_plane(size=14)
    floor.data.materials.append(blender.new_material("Floor", shader, Color=(0.7, 0.7, 0.7, 1), **inputs))
    for i in range(40):
        data = bpy.data.lights.new(f"Lamp {i}", "AREA" if i % 2 else "POINT")
        data.energy = 2.0 + i % 5
        if i % 2:
            data.size = 0.35
        else:
            data.shadow_soft_size, data.use_soft_falloff = 0.15, False
        blender.link(data.name, data, (0.7 * (i % 8) - 2.4, 0.7 * (i // 8) - 1.4, 1.0 + 0.1 * (i % 3)))
    camera = blender.add_camera(location=(0.2, -5.5, 3.0), width=48, height=48)
    camera.rotation_euler = Euler((math.radians(62), 0, 0))
    bpy.context.scene.world = None


@pytest.mark.parametrize(
    ("shader", "roughness"), [("ShaderNodeBsdfDiffuse", None), ("ShaderNodeBsdfGlossy", 0.0)], ids=["diffuse", "mirror"]
)
def test_many_lamps_are_as_in_cycles(shader, roughness, tmp_path):
    """Blocks to 1 %; 2 % too much is noticed."""
    hall(shader, roughness)
    parity.be_exact(512, max_depth=1)
    glanz, cycles = parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path)
    assert parity.difference(glanz, cycles) < MOST
    assert parity.difference(1.02 * glanz, cycles) > MOST
