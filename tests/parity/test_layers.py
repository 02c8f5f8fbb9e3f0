"""Rough and layered surfaces reflect as much as in Cycles: a sphere in a grey world, ring by ring."""

import itertools

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender
from glanz.tests.parity import parity

SAMPLES = 256
RINGS = (0.0, 0.4, 0.6, 0.75, 0.87)
"""Distances from the middle of the sphere, of which 1 is the rim: cosines of 1, 0.92, 0.8, 0.66 and 0.49."""


CASES = {
    "diffuse": ("ShaderNodeBsdfDiffuse", {"Color": (0.8, 0.8, 0.8, 1)}, 0.03),
    **{
        f"principled r{r} m{m} t{t} ior{ior}": (
            "ShaderNodeBsdfPrincipled",
            {"Base_Color": (0.8, 0.5, 0.2, 1), "Roughness": r, "Metallic": m, "Transmission_Weight": t, "IOR": ior},
            0.1 if r else 0.03,
        )
        for r in (0, 0.25, 0.5, 1)
        for m, t, ior in ((0, 0, 1.5), (0, 0, 2.0), (1, 0, 1.5), (0, 1, 1.33))
    },
    "coat": ("ShaderNodeBsdfPrincipled", {"Base_Color": (0.5, 0.1, 0.1, 1), "Roughness": 0.5, "Coat_Weight": 1}, 0.1),
    **{f"glossy r{r}": ("ShaderNodeBsdfAnisotropic", {"Color": (0.8, 0.8, 0.8, 1), "Roughness": r}, 0.1) for r in (0.25, 1)},
}


def sphere(node, values):
    """A scene of nothing but a sphere that fills the picture in a grey world."""
    camera = blender.add_camera(location=(0, 0, 5), width=48, height=48)
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2
    blender.set_world((0.5, 0.5, 0.5))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48)
    ball = bpy.context.object
    ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
    ball.data.materials.append(blender.new_material("Ball", node, **values))
    parity.be_exact(SAMPLES, 12)
    cycles = bpy.context.scene.cycles
    cycles.glossy_bounces = cycles.transmission_bounces = 12
    cycles.caustics_reflective = cycles.caustics_refractive = True


def rings(image):
    """Means (rings, 3) of a picture of the sphere, over the radiance of the world."""
    x = (np.arange(48) + 0.5) / 24 - 1
    r = np.hypot(*np.meshgrid(x, x))
    return np.array([image[(r >= a) & (r < b)].mean(axis=0) for a, b in itertools.pairwise(RINGS)]) / 0.5


def deviation(tmp_path):
    """The largest difference of a ring's albedo, over Cycles' brightest channel there."""
    ours, theirs = (rings(parity.pixels(engine, tmp_path)) for engine in ("GLANZ", "CYCLES"))
    return np.abs(ours - theirs).max() / theirs.max(), ours, theirs


@pytest.mark.parametrize("name", CASES)
def test_as_much_light_leaves_as_in_cycles(name, tmp_path):
    """Within 3 % where it is smooth or diffuse, and 10 % where it is rough."""
    node, values, tolerance = CASES[name]
    sphere(node, values)
    found, ours, theirs = deviation(tmp_path)
    print(f"{name}: {found:.2%}")
    assert found <= tolerance, (ours.round(3).tolist(), theirs.round(3).tolist())
