"""Mirrors and glass look as in Cycles: a smooth ball over a floor, under a lamp and a bright world."""

import bpy
import numpy as np
import pytest

from glanz.engine.bsdfs.dielectric import Dielectric
from glanz.tests.addon import blender
from glanz.tests.parity import parity

SAMPLES = 1024
TOLERANCE = 0.015
"""Of block means. Two seeds of either engine differ by up to 0.5 %, the engines by up to 1 %, as measured with two seeds each."""
MATERIALS = {
    "mirror": ("ShaderNodeBsdfAnisotropic", {"Color": (0.9, 0.7, 0.5, 1), "Roughness": 0}),
    "glass": ("ShaderNodeBsdfGlass", {"Color": (0.9, 0.95, 1, 1), "Roughness": 0, "IOR": 1.5}),
    "principled glass": (
        "ShaderNodeBsdfPrincipled",
        {"Base_Color": (0.5, 0.8, 0.9, 1), "Transmission_Weight": 1, "Roughness": 0, "IOR": 1.4},
    ),
}


def ball_over_floor(name):
    """The scene, with a ball of MATERIALS[name]."""
    camera = blender.add_camera(location=(0, -7, 3), width=64, height=64)
    camera.rotation_euler = (1.25, 0, 0)
    blender.set_world((0.6, 0.7, 0.8))
    blender.add_plane(size=8).data.materials.append(blender.new_material("Floor", "ShaderNodeBsdfDiffuse", Color=(0.6, 0.5, 0.4, 1)))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, location=(0, 0, 1))
    ball = bpy.context.object
    ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
    node, values = MATERIALS[name]
    ball.data.materials.append(blender.new_material("Ball", node, **values))
    lamp = bpy.data.lights.new("Lamp", "AREA")
    lamp.size, lamp.energy = 2, 200
    blender.link("Lamp", lamp, (2, -1, 4)).rotation_euler = (0.2, 0.4, 0)
    parity.be_exact(SAMPLES, 12)
    cycles = bpy.context.scene.cycles
    cycles.glossy_bounces = cycles.transmission_bounces = 12
    cycles.caustics_reflective = cycles.caustics_refractive = True


@pytest.mark.parametrize("name", MATERIALS)
def test_a_smooth_ball_looks_as_in_cycles(name, tmp_path):
    """Means of 16 blocks within 1.5 %, of the picture within 0.15 %."""
    ball_over_floor(name)
    ours, theirs = (parity.pixels(engine, tmp_path) for engine in ("GLANZ", "CYCLES"))
    assert parity.difference(ours, theirs) <= TOLERANCE
    assert abs(ours.mean() / theirs.mean() - 1) <= 0.0015


def test_the_comparison_catches_glass_of_another_index(monkeypatch, tmp_path):
    """1.45 instead of 1.5."""
    ball_over_floor("glass")
    row = Dielectric.row
    monkeypatch.setattr(Dielectric, "row", lambda self: row(self) | {"ior": 1.45})
    ours, theirs = (parity.pixels(engine, tmp_path) for engine in ("GLANZ", "CYCLES"))
    assert np.isfinite(ours).all()
    assert parity.difference(ours, theirs) > TOLERANCE
