"""Dull, mirroring and clear things under every kind of light look as in Cycles, tile by tile.

Each scene has a dull floor and box, a mirror ball and a glass ball; each kind of light alone. Means of blocks within 1 %,
where noise lets it be known, and no tile of 16 x 16 pixels that differs significantly (see `welch`).
The lamps are large, or the glass ball would gather their light into a caustic that few paths find, and means of few
replicates would not be normal.
"""

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender
from glanz.tests.parity import parity, welch

SAMPLES, REPLICATES, BOUNCES = 192, 8, 8
TOLERANCE = 0.01
ENOUGH = 8
"""Means of tiles that must be known well enough to be held to TOLERANCE."""


def lamp(kind, energy, **attributes):
    def add():
        data = bpy.data.lights.new("Lamp", kind)
        data.energy = energy
        for name, value in attributes.items():
            setattr(data, name, value)
        blender.link("Lamp", data, (1.5, -1.5, 3.5)).rotation_euler = (0.45, 0.3, 0.2)

    return add


def glowing_ball():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=0.5, location=(1.2, -1.0, 3.2))
    bpy.context.object.data.materials.append(blender.new_material("Glow", "ShaderNodeEmission", Color=(1, 0.8, 0.6, 1), Strength=20))


def bright_world():
    blender.set_world((0.7, 0.8, 1.0))


LIGHTS = {
    "point": lamp("POINT", 400, shadow_soft_size=0.0),
    "ball": lamp("POINT", 400, shadow_soft_size=1.0, use_soft_falloff=False),
    "spot": lamp("SPOT", 1500, shadow_soft_size=1.2, spot_size=1.4, spot_blend=0.4),
    "sun": lamp("SUN", 4, angle=0.4),
    "square": lamp("AREA", 300, shape="SQUARE", size=2.5),
    "ellipse": lamp("AREA", 300, shape="ELLIPSE", size=3, size_y=2, spread=2.5),
    "mesh": glowing_ball,
    "world": bright_world,
}


def ball(name, node, location, radius, **values):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=radius, location=location)
    made = bpy.context.object
    made.data.polygons.foreach_set("use_smooth", [True] * len(made.data.polygons))
    made.data.materials.append(blender.new_material(name, node, **values))
    owner = made if hasattr(made, "shadow_terminator_geometry_offset") else made.cycles
    owner.shadow_terminator_geometry_offset = 0
    return made


def still_life(add_light):
    camera = blender.add_camera(location=(0, -7, 3), width=64, height=64)
    camera.rotation_euler = (1.25, 0, 0)
    blender.set_world((0, 0, 0))
    blender.add_plane(size=9).data.materials.append(blender.new_material("Floor", "ShaderNodeBsdfDiffuse", Color=(0.6, 0.5, 0.4, 1)))
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(-0.2, 1.4, 0.5), rotation=(0, 0, 0.4))
    bpy.context.object.data.materials.append(blender.new_material("Box", "ShaderNodeBsdfDiffuse", Color=(0.2, 0.5, 0.7, 1)))
    ball("Mirror", "ShaderNodeBsdfAnisotropic", (-1.1, 0, 0.8), 0.8, Color=(0.9, 0.8, 0.6, 1), Roughness=0)
    ball("Glass", "ShaderNodeBsdfGlass", (0.9, -0.3, 0.8), 0.8, Color=(1, 1, 1, 1), Roughness=0, IOR=1.45)
    add_light()
    parity.be_exact(SAMPLES, BOUNCES)
    cycles = bpy.context.scene.cycles
    cycles.glossy_bounces = cycles.transmission_bounces = BOUNCES
    cycles.caustics_reflective = cycles.caustics_refractive = True


def both(path):
    return (welch.replicates(engine, path, REPLICATES) for engine in ("GLANZ", "CYCLES"))


@pytest.mark.parametrize("kind", LIGHTS)
def test_a_still_life_under_each_light_looks_as_in_cycles(kind, tmp_path):
    still_life(LIGHTS[kind])
    ours, theirs = both(tmp_path)
    differences = welch.block_differences(ours, theirs)
    # Of 48 means of tiles, 12 are of the black sky.
    assert differences.size >= ENOUGH
    assert differences.max() <= TOLERANCE
    assert welch.agree(ours, theirs)


def test_the_comparison_catches_light_that_is_three_percent_stronger(tmp_path):
    """By Welch's test alone: what it notices is printed when it does not."""
    still_life(LIGHTS["square"])
    theirs = welch.replicates("CYCLES", tmp_path, REPLICATES)
    bpy.data.lights["Lamp"].energy *= 1.03
    ours = welch.replicates("GLANZ", tmp_path, REPLICATES)
    assert np.isfinite(ours).all()
    assert not welch.agree(ours, theirs), welch.smallest_difference(ours, theirs)
