"""Passes of light and colour hold what Cycles' hold, under its names, so that set-ups of the compositor survive a change of engines."""

import bpy
import numpy as np

from glanz.addon import passes
from glanz.engine.bsdfs.lambert_transmission import LambertTransmission
from glanz.tests.addon import blender
from glanz.tests.parity import parity

SAMPLES = 400
BLOCKS = 2
TOLERANCE, OF_NOISY = 0.02, 0.12
"""Of block means, or of half of the brightest block where they are darker. Other seeds of Cycles differ by half as much."""
NOISY = ("Diffuse Indirect", "Glossy Direct", "Glossy Indirect", "Transmission Indirect")
"""What mirrors and glass find by chance."""
NOT_LIGHT = ("Denoising", "Ambient", "Shadow", "Standard", "Confidence")
PASSES = tuple(key for key, row in passes.TABLE.items() if row.kind == "COLOR" and not key.startswith(NOT_LIGHT))


def still_life():
    """A dull, shiny and a glass ball, and a leaf, on a floor, under a bulb without a size, a glowing panel and a sky."""
    camera = blender.add_camera(location=(0, -6, 2.5), width=32, height=32)
    camera.rotation_euler = (1.2, 0, 0)
    blender.set_world((0.3, 0.35, 0.4))
    blender.add_plane(size=12).data.materials.append(blender.new_material("Floor", "ShaderNodeBsdfDiffuse", Color=(0.6, 0.5, 0.4, 1)))
    kinds = {
        "Plastic": ("ShaderNodeBsdfPrincipled", {"Base Color": (0.2, 0.5, 0.8, 1), "Roughness": 0.0}),
        "Metal": ("ShaderNodeBsdfGlossy", {"Color": (0.9, 0.7, 0.4, 1), "Roughness": 0.0}),
        "Glass": ("ShaderNodeBsdfGlass", {"Color": (0.9, 1.0, 0.9, 1), "Roughness": 0.0, "IOR": 1.5}),
    }
    for i, (name, (node, inputs)) in enumerate(kinds.items()):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=0.6, location=(-1.5 + 1.5 * i, 0, 0.6))
        bpy.ops.object.shade_smooth()
        bpy.context.object.data.materials.append(blender.new_material(name, node, **inputs))
    leaf = blender.add_plane("Leaf", 1.5, (0.7, 2, 1.2))
    leaf.rotation_euler = (1.3, 0, 0.3)
    leaf.data.materials.append(blender.new_material("Leaf", "ShaderNodeBsdfTranslucent", Color=(0.3, 0.7, 0.2, 1)))
    panel = blender.add_plane("Panel", 1, (-1.5, 2, 1.5))
    panel.rotation_euler = (1.2, 0, 0)
    panel.data.materials.append(blender.new_material("Panel", "ShaderNodeEmission", Color=(1, 0.8, 0.6, 1), Strength=3))
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.shadow_soft_size, lamp.energy = 0, 150
    blender.link("Lamp", lamp, (1, 2, 4))
    parity.be_exact(SAMPLES, 4)
    cycles = bpy.context.scene.cycles
    cycles.glossy_bounces = cycles.transmission_bounces = 4
    cycles.caustics_reflective = cycles.caustics_refractive = True
    layer = bpy.context.view_layer
    for key in PASSES:
        if passes.TABLE[key].flag:
            setattr(*passes.switch(layer, passes.TABLE[key].flag), True)


def rendered(engine, path):
    """{pass: (height, width, 3)} as the file has them."""
    bpy.context.scene.render.engine = engine
    found = blender.read_exr(blender.render(path / f"{engine}.exr"))
    by_name = {name.split(".")[-1]: values[..., :3].astype(np.float64) for name, values in found.items()}
    return {key: by_name[passes.name_of(key)] for key in PASSES}


def beyond(ours, theirs):
    """{pass: how far the means of its blocks are from Cycles', in bars} where that is more than one."""
    result = {}
    for key in PASSES:
        a, b = (parity.block_means(image[key], BLOCKS).mean(axis=-1) for image in (ours, theirs))
        bar = OF_NOISY if key in NOISY else TOLERANCE
        result[key] = float((np.abs(a - b) / np.maximum(b, 0.5 * max(b.max(), 1e-3))).max() / bar)
    return {key: bars for key, bars in result.items() if bars > 1}


def test_passes_are_those_of_cycles(tmp_path):
    still_life()
    assert beyond(rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path)) == {}


def test_the_comparison_catches_light_of_the_wrong_lobes(monkeypatch, tmp_path):
    """The mutant takes translucent leaves for what passes, not for what is dull."""
    still_life()
    monkeypatch.setattr(LambertTransmission, "is_diffuse", False)
    lost = beyond(rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path))
    assert {"Diffuse Color", "Transmission Color", "Transmission Direct"} <= lost.keys()
