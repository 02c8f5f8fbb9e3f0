"""Bump and Normal Map nodes become reliefs, in the order in which they follow each other."""

import bpy
import pytest

from glanz.engine import BumpMap, CheckerTexture, ImageTexture, NormalMap
from glanz.tests.addon import blender


def bent(shader="ShaderNodeBsdfDiffuse"):
    """(material, tree, shader node)."""
    material = blender.new_material("Mat", shader)
    return material, material.node_tree, next(n for n in material.node_tree.nodes if n.bl_idname == shader)


def add_bump(tree, target, **inputs):
    bump = blender.add_node(tree, "ShaderNodeBump", **inputs)
    tree.links.new(tree.nodes.new("ShaderNodeTexChecker").outputs["Fac"], blender.node_input(bump, "Height"))
    tree.links.new(bump.outputs[0], blender.node_input(target, "Normal"))
    return bump


def add_map(tree, target, **inputs):
    node = blender.add_node(tree, "ShaderNodeNormalMap", **inputs)
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = bpy.data.images.new("Normals", 2, 2)
    tree.links.new(image.outputs["Color"], blender.node_input(node, "Color"))
    tree.links.new(node.outputs[0], blender.node_input(target, "Normal"))
    return node


def exported(material):
    blender.add_plane().data.materials.append(material)
    scene, warnings = blender.export()
    return scene.objects[0].materials[0].relief, warnings


SHADERS = ["ShaderNodeBsdfDiffuse", "ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfGlass", "ShaderNodeBsdfPrincipled"]


@pytest.mark.parametrize("shader", SHADERS)
@pytest.mark.parametrize("inverted", [False, True])
def test_bump(shader, inverted):
    material, tree, node = bent(shader)
    if shader == "ShaderNodeBsdfGlass":
        blender.node_input(node, "Roughness").default_value = 0
    add_bump(tree, node, Strength=0.5, Distance=0.25).invert = inverted
    (relief,), warnings = exported(material)
    assert warnings == ()
    assert type(relief) is BumpMap
    assert (relief.distance, relief.strength, relief.is_dug, relief.normal) == (0.25, 0.5, inverted, None)
    assert type(relief.texture) is CheckerTexture


def test_normal_map():
    material, tree, node = bent()
    add_map(tree, node, Strength=0.5).uv_map = "Second"
    (relief,), warnings = exported(material)
    assert type(relief) is NormalMap
    assert (relief.strength, relief.layer) == (0.5, "Second")
    assert type(relief.texture) is ImageTexture
    assert warnings == ("there is no UV map 'Second', it counts as 0: mesh 'Plane'",)


def test_a_bump_on_a_normal_map_comes_after_it():
    material, tree, node = bent()
    add_map(tree, add_bump(tree, node))
    (relief,), _ = exported(material)
    assert (type(relief), type(relief.normal)) == (BumpMap, NormalMap)


@pytest.mark.parametrize("space", ["OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD"])
def test_normal_maps_come_with_their_space(space):
    material, tree, node = bent()
    add_map(tree, node).space = space
    (relief,), warnings = exported(material)
    assert warnings == ()
    assert relief.space == space.lower().replace("_", " ")


def test_a_bump_of_equal_height_is_none():
    material, tree, node = bent()
    bump = tree.nodes.new("ShaderNodeBump")
    tree.links.new(bump.outputs[0], blender.node_input(node, "Normal"))
    assert exported(material) == ((), ())


def test_any_vector_may_be_a_normal():
    material, tree, node = bent()
    tree.links.new(tree.nodes.new("ShaderNodeTexChecker").outputs["Color"], blender.node_input(node, "Normal"))
    (relief,), warnings = exported(material)
    assert warnings == ()
    assert type(relief) is CheckerTexture


def test_shaders_with_different_normals_are_named():
    material, tree, node = bent()
    add_bump(tree, node)
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(node.outputs[0], mix.inputs[1])
    tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    reliefs, (warning,) = exported(material)
    assert type(reliefs[0]) is BumpMap
    assert "different normals" in warning


def test_the_output_of_a_light_serves_in_a_material():
    """As in Cycles; it has no input for displacement, nor for a volume."""
    material = bpy.data.materials.new("M")
    tree = blender.new_nodes(material)
    shader = blender.add_node(tree, "ShaderNodeBsdfDiffuse", Color=(0.25, 0.5, 0.75, 1))
    tree.links.new(shader.outputs[0], tree.nodes.new("ShaderNodeOutputLight").inputs["Surface"])
    blender.add_plane("Plane").data.materials.append(material)
    (lobe,) = blender.export_object("Plane").materials[0].lobes
    assert lobe.reflectance == pytest.approx((0.25, 0.5, 0.75))
