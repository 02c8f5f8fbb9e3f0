"""Worlds with a picture, for the add-on's tests."""

import bpy
import numpy as np

from glanz.tests.addon import blender


def new_image(pixels, is_float=True, alpha=1.0, name="Sky"):
    """A packed image of (H, W, 3), row 0 at the top."""
    height, width, _ = pixels.shape
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    rgba = np.full((height, width, 4), alpha, np.float32)
    rgba[..., :3] = pixels
    image.pixels.foreach_set(rgba[::-1].ravel())
    image.update()
    image.pack()
    return image


def set_sky(image, strength=1.0, interpolation="Linear", projection="EQUIRECTANGULAR", vector_type=None, **mapping):
    """The world's Background shows `image`; `vector_type` puts a Mapping node with the inputs `mapping` before it."""
    world = blender.set_world((0.3, 0.3, 0.3), strength)
    tree = world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image, texture.interpolation, texture.projection = image, interpolation, projection
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    if vector_type:
        node = tree.nodes.new("ShaderNodeMapping")
        node.vector_type = vector_type
        for name, value in mapping.items():
            blender.node_input(node, name).default_value = value
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(coordinates.outputs["Generated"], node.inputs["Vector"])
        tree.links.new(node.outputs["Vector"], texture.inputs["Vector"])
    return texture
