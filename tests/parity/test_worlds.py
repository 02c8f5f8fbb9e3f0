"""Worlds made of nodes are those of Cycles, direction by direction, and light what they light in Cycles."""

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender
from glanz.tests.parity import parity


def noise(tree, background):
    tree.links.new(blender.add_node(tree, "ShaderNodeTexNoise", Scale=2.0, Detail=2.0).outputs["Color"], background.inputs["Color"])


def gradient(tree, background):
    """Of the direction's z, from a mapping."""
    source, mapping = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
    blender.node_input(mapping, "Rotation").default_value = (0.3, 1.2, 0.4)
    blender.node_input(mapping, "Location").default_value = (0.4, 0.1, 0.2)
    pattern = tree.nodes.new("ShaderNodeTexGradient")
    tree.links.new(source.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], pattern.inputs["Vector"])
    tree.links.new(pattern.outputs["Color"], background.inputs["Color"])


def stretched_picture(tree, background):
    """An equirectangular picture whose directions are scaled."""
    image = bpy.data.images.new("Sky", 16, 8, float_buffer=True)
    pixels = np.random.default_rng(3).random((8, 16, 4)).astype(np.float32)
    pixels[..., 3] = 1
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    texture, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
    texture.image = image
    blender.node_input(mapping, "Scale").default_value = (1.0, 1.7, 0.6)
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])


def two_backgrounds(tree, background):
    """Mixed by a checker."""
    noise(tree, background)
    other = blender.add_node(tree, "ShaderNodeBackground", Color=(0.9, 0.4, 0.1, 1), Strength=0.5)
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(blender.add_node(tree, "ShaderNodeTexChecker", Scale=3.0).outputs["Fac"], mix.inputs[0])
    for shader, socket in zip((background, other), mix.inputs[1:]):
        tree.links.new(shader.outputs[0], socket)
    tree.links.new(mix.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])


WORLDS = (noise, gradient, stretched_picture, two_backgrounds)


def set_up(make):
    tree = blender.set_world((1, 1, 1)).node_tree
    make(tree, next(n for n in tree.nodes if n.type == "BACKGROUND"))


@pytest.mark.parametrize("make", WORLDS, ids=lambda f: f.__name__)
def test_a_world_is_that_of_cycles_in_every_direction(make, tmp_path):
    """Through the middles of pixels; where the picture is stretched, texels are interpolated alike."""
    camera = blender.add_camera((0, 0, 0), 64, 48, lens=12.0)
    camera.rotation_euler = (1.2, 0.2, 0.7)
    set_up(make)
    parity.be_exact(1, max_depth=0)
    scene = bpy.context.scene
    scene.glanz.pixel_filter, scene.cycles.pixel_filter_type = "blackman_harris", "BLACKMAN_HARRIS"
    scene.glanz.filter_width = scene.cycles.filter_width = 0.01
    ours, theirs = parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path)
    assert theirs.std() > 0.05
    assert (np.abs(ours - theirs).max(axis=2) <= 1 / 255).mean() >= 0.98


@pytest.mark.parametrize("make", WORLDS, ids=lambda f: f.__name__)
def test_a_world_lights_what_it_lights_in_cycles(make, tmp_path):
    # Not towards a pole, where a picture has no direction.
    camera = blender.add_camera((0, -5, 0), 32, 32, type="ORTHO", ortho_scale=2.0)
    camera.rotation_euler = (1.5, 0, 0)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.9)
    bpy.ops.object.shade_smooth()
    ball = bpy.context.object
    ball.data.materials.append(blender.new_material("Dull", "ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8, 1), Roughness=0))
    set_up(make)
    parity.be_exact(256, max_depth=1)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path), blocks=2) <= 0.01
