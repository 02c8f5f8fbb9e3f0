"""Transparent surfaces look, and cast shadows, as in Cycles: cards over a floor, under each kind of light and a bright world."""

import bpy
import numpy as np
import pytest

from glanz.engine.wavefront import passing
from glanz.tests.addon import blender
from glanz.tests.addon.export.test_alpha import leaf
from glanz.tests.parity import parity

SAMPLES = 400
TOLERANCE = 0.01
LAMPS = {
    "sun": ("SUN", {"energy": 3, "angle": 0.2}),
    "area": ("AREA", {"energy": 300, "size": 1.5}),
    "point": ("POINT", {"energy": 400, "shadow_soft_size": 0.0}),
}


def mixed(colour, factor):
    """A card that is Transparent and Diffuse, mixed."""
    material = bpy.data.materials.new("Mixed")
    tree = blender.new_nodes(material)
    mix = blender.add_node(tree, "ShaderNodeMixShader", Fac=factor)
    tree.links.new(blender.add_node(tree, "ShaderNodeBsdfTransparent", Color=colour).outputs[0], mix.inputs[1])
    tree.links.new(blender.add_node(tree, "ShaderNodeBsdfDiffuse", Color=(0.7, 0.3, 0.5, 1)).outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def glowing(strength):
    """A card that lets everything pass and glows: light that is sampled through itself and the other cards."""
    material = bpy.data.materials.new("Glowing")
    tree = blender.new_nodes(material)
    add = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(blender.add_node(tree, "ShaderNodeBsdfTransparent", Color=(1, 1, 1, 1)).outputs[0], add.inputs[0])
    tree.links.new(blender.add_node(tree, "ShaderNodeEmission", Color=(1, 0.8, 0.5, 1), Strength=strength).outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def cards_over_floor(lamp):
    """Three cards above each other, from the side: mixed, Principled with alpha, and glowing."""
    camera = blender.add_camera(location=(0, -7, 3.5), width=64, height=64)
    camera.rotation_euler = (1.15, 0, 0)
    blender.set_world((0.2, 0.25, 0.3))
    blender.add_plane(size=12).data.materials.append(blender.new_material("Floor", "ShaderNodeBsdfDiffuse", Color=(0.6, 0.5, 0.4, 1)))
    matte = {"Base_Color": (0.3, 0.6, 0.8, 1), "Specular_IOR_Level": 0, "Roughness": 1}
    principled = blender.new_material("Thin", "ShaderNodeBsdfPrincipled", Alpha=0.4, **matte)
    for i, material in enumerate((mixed((0.9, 0.6, 0.2, 1), 0.3), principled, glowing(0.5))):
        card = blender.add_plane(f"Card {i}", 2.0, (0.5 * i - 0.6, 0.3 * i, 0.5 + 0.5 * i))
        card.rotation_euler = (0.2 * i, 0.3 - 0.2 * i, 0.1)
        card.data.materials.append(material)
    kind, values = LAMPS[lamp]
    data = bpy.data.lights.new("Lamp", kind)
    for name, value in values.items():
        setattr(data, name, value)
    blender.link("Lamp", data, (1, -0.5, 4)).rotation_euler = (0.1, 0.25, 0)
    parity.be_exact(SAMPLES, 4)
    bpy.context.scene.cycles.transparent_max_bounces = 64


@pytest.mark.parametrize("lamp", LAMPS)
def test_cards_look_and_cast_shadows_as_in_cycles(lamp, tmp_path):
    """Means of 16 blocks within 1 %, of the picture within 0.2 %."""
    cards_over_floor(lamp)
    ours, theirs = (parity.pixels(engine, tmp_path) for engine in ("GLANZ", "CYCLES"))
    assert parity.difference(ours, theirs) <= TOLERANCE
    assert abs(ours.mean() / theirs.mean() - 1) <= 0.002


def leaf_image():
    """A round leaf with holes, red to green, that fades out at its border; what is around it is magenta, and must not be seen."""
    y, x = np.mgrid[-1:1:64j, -1:1:64j]
    alpha = np.clip((0.9 - np.hypot(x, y)) * 6, 0, 1) * (np.hypot(x - 0.3, y - 0.2) > 0.25)
    pixels = np.dstack((0.5 + 0.4 * x, 0.5 - 0.3 * y, 0.2 + 0 * x, alpha)).astype(np.float32)
    pixels[alpha == 0, :3] = (1, 0, 1)
    image = bpy.data.images.new("Leaf", 64, 64, alpha=True)
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    return image


@pytest.mark.parametrize("lamp", ["area", "point"])
def test_leaves_on_cards_look_and_cast_shadows_as_in_cycles(lamp, tmp_path):
    cards_over_floor(lamp)
    for i, (ob, is_principled) in enumerate(((bpy.data.objects["Card 0"], False), (bpy.data.objects["Card 1"], True))):
        ob.data.uv_layers.new(name="UV").data.foreach_set("uv", (0, 0, 1, 0, 1, 1, 0, 1))
        material, picture = leaf(is_principled)
        picture.image, picture.interpolation = leaf_image(), ("Closest", "Linear")[i]
        ob.data.materials[0] = material
    ours, theirs = (parity.pixels(engine, tmp_path) for engine in ("GLANZ", "CYCLES"))
    assert parity.difference(ours, theirs) <= TOLERANCE
    assert abs(ours.mean() / theirs.mean() - 1) <= 0.002


def test_the_comparison_catches_shadows_that_are_not_weakened(monkeypatch, tmp_path):
    cards_over_floor("area")
    monkeypatch.setattr(passing, "_transmittance", lambda plan, rays, o, d, limit: 0 * o)
    ours, theirs = (parity.pixels(engine, tmp_path) for engine in ("GLANZ", "CYCLES"))
    assert np.isfinite(ours).all()
    assert parity.difference(ours, theirs) > TOLERANCE
