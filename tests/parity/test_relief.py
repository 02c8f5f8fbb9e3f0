"""A bumpy and a normal-mapped plane under two suns against Cycles: block means.

The uv layer is affine, so that tangents are the same for all triangles: Cycles averages them at shared corners.
"""

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender
from glanz.tests.parity import parity


def scene_with(kind):
    blender.add_camera((0, 0, 5), 64, 64, type="ORTHO", ortho_scale=1.9)
    plane = blender.add_plane(size=2.0)
    plane.data.uv_layers.new(name="UVMap").uv.foreach_set("vector", [0.1, 0.0, 1.1, 0.1, 1.0, 1.1, 0.0, 1.0])
    material = blender.new_material("Bent", "ShaderNodeBsdfDiffuse")
    plane.data.materials.append(material)
    tree = material.node_tree
    shader = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE")
    if kind == "bump":
        node = blender.add_node(tree, "ShaderNodeBump", Strength=0.8, Distance=0.2)
        noise = blender.add_node(tree, "ShaderNodeTexNoise", Scale=3, Detail=0)
        tree.links.new(noise.outputs[0], blender.node_input(node, "Height"))
    else:
        node = blender.add_node(tree, "ShaderNodeNormalMap", Strength=0.7)
        texture = tree.nodes.new("ShaderNodeTexImage")
        image = bpy.data.images.new("Normals", 8, 8)
        image.colorspace_settings.name = "Non-Color"
        normals = np.random.default_rng(2).normal(0, 0.4, (64, 3))
        normals[:, 2] = 1
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        image.pixels.foreach_set(np.concatenate((0.5 + 0.5 * normals, np.ones((64, 1))), axis=1).astype(np.float32).ravel())
        image.update()
        image.pack()
        texture.image = image
        tree.links.new(texture.outputs["Color"], blender.node_input(node, "Color"))
    tree.links.new(node.outputs[0], blender.node_input(shader, "Normal"))
    for direction, energy in (((0.9, 0.2, 0), 2.0), ((-0.3, -0.8, 0), 1.0)):
        sun = blender.link("Sun", bpy.data.lights.new("Sun", "SUN"))
        sun.data.energy, sun.data.angle, sun.rotation_euler = energy, 0.0, direction
    return shader


@pytest.mark.parametrize("kind", ["bump", "normal map"])
def test_reliefs_are_those_of_cycles(kind, tmp_path):
    """8 x 8 blocks, to 1 %; without the relief they differ by more than 5 %."""
    shader = scene_with(kind)
    parity.be_exact(64, max_depth=0)
    glanz, cycles = parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path)
    assert parity.difference(glanz, cycles, 8) < 0.01
    tree = bpy.data.materials["Bent"].node_tree
    tree.links.remove(blender.node_input(shader, "Normal").links[0])
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, 8) > 0.05
