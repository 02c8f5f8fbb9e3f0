"""Whatever the nodes, a picture follows: no exception, no NaN, no light from nowhere, and what is not known is named."""

import bpy
import numpy as np
import pytest
from hypothesis import given, note, strategies as st

from glanz.addon.export import shaders as known
from glanz.addon.export.values import TABLE
from glanz.engine import Dielectric, Settings, render_image
from glanz.tests.addon import blender
from glanz.tests.addon.export import trees
from glanz.tests.chance import law

NODES = trees.offered()
SHADERS, VALUES = NODES


def stage(name="Odd"):
    """(material, tree, its surface) of a closed box under a white world, seen from above."""
    for data in (bpy.data.objects, bpy.data.materials, bpy.data.meshes, bpy.data.cameras, bpy.data.worlds):
        for block in list(data):
            data.remove(block)
    blender.add_camera((0.3, 0.4, 6), type="ORTHO", ortho_scale=1.5)
    blender.set_world((1, 1, 1))
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    box = blender.link("Box", blender.new_mesh("Box", corners, faces))
    box.rotation_euler = (0.4, 0.3, 0.2)
    material = bpy.data.materials.new(name)
    box.data.materials.append(material)
    tree = blender.new_nodes(material)
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"]


def image(scene, side=8, samples=2, depth=3):
    return render_image(scene, Settings(width=side, height=side, samples=samples, max_depth=depth, threads=1))


def picture(scene):
    return image(scene).passes["Combined"]


def told(tree):
    """The links of a tree, for whoever has to find out."""
    ends = ((link.from_node, link.from_socket, link.to_node, link.to_socket) for link in tree.links)
    return "\n".join(f"{a.bl_idname}.{start.identifier} -> {b.name}.{end.identifier}" for a, start, b, end in ends)


def is_known(node):
    return node.type in TABLE or node.type in known._TABLE


@given(st.data())
@law(quick=120, thorough=1000)
def test_any_tree_gives_a_finite_picture(data):
    _, tree, surface = stage()
    trees.grow(data.draw, tree, surface, NODES, trees.DEPTH)
    note(told(tree))
    scene, _ = blender.export()
    assert np.isfinite(picture(scene)).all()


@given(st.data())
@law(quick=60, thorough=1000)
def test_no_tree_reflects_more_than_it_receives(data):
    """In a white furnace nothing is brighter than its surroundings."""
    _, tree, surface = stage()
    numbers = data.draw(st.sampled_from((trees.EVEN, trees.ODD)))
    trees.grow(data.draw, tree, surface, (trees.without_glow(SHADERS), VALUES), trees.DEPTH, numbers)
    trees.black_glow(tree)
    note(told(tree))
    scene, _ = blender.export()
    assert not gains(scene)


def gains(scene):
    """Whether the box is brighter than the white world around it, beyond the noise of 64 pixels with 16 samples each.

    Or whether a path ended in something that is no number, which the film leaves out.
    """
    found = image(scene, samples=16, depth=8)
    if any("not finite" in line for line in found.warnings):
        return True
    found = found.passes["Combined"][..., :3].reshape(-1, 3)
    return bool((found.mean(axis=0) > 1 + 1e-3 + 5 * found.std(axis=0) / np.sqrt(len(found))).any())


def test_light_from_nowhere_is_noticed():
    _, tree, surface = stage()
    add = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(add.outputs[0], surface)
    parts = {"ShaderNodeBsdfDiffuse": {"Color": (1, 1, 1, 1)}, "ShaderNodeEmission": {"Strength": 0.02}}
    for socket, (name, values) in zip(add.inputs, parts.items()):
        tree.links.new(blender.add_node(tree, name, **values).outputs[0], socket)
    assert gains(blender.export()[0])


@pytest.mark.parametrize("shader", ["ShaderNodeBsdfRefraction", "ShaderNodeBsdfGlass"])
def test_paper_beside_glass_gives_no_light(shader):
    """What is inside of glass is brighter by the square of its index, and must not get out as it is: found by chance, at 1.14."""
    _, tree, surface = stage()
    add = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(add.outputs[0], surface)
    for socket, name in zip(add.inputs, (shader, "ShaderNodeBsdfTranslucent")):
        tree.links.new(blender.add_node(tree, name, Color=(1, 1, 1, 1)).outputs[0], socket)
    assert not gains(blender.export()[0])


def test_a_normal_that_is_no_number_gives_a_finite_picture():
    """Found by chance: the table of what a rough boundary lets through was looked up anywhere."""
    _, tree, surface = stage()
    mapping = blender.add_node(tree, "ShaderNodeMapping", Location=(np.inf, -np.inf, 0.0), Rotation=(1.0, 0.0, 1.0))
    mapping.vector_type = "TEXTURE"
    glass = blender.add_node(tree, "ShaderNodeBsdfGlass", Roughness=1.0)
    tree.links.new(mapping.outputs[0], glass.inputs["Normal"])
    tree.links.new(glass.outputs[0], surface)
    assert np.isfinite(picture(blender.export()[0])).all()


def test_a_link_from_an_output_that_a_mode_has_put_away_is_none():
    """Found by chance: a vector came where a number was meant, and the export ended in a TypeError."""
    _, tree, surface = stage()
    ranged = blender.add_node(tree, "ShaderNodeMapRange")
    glass = blender.add_node(tree, "ShaderNodeBsdfGlass", IOR=1.3)
    tree.links.new(ranged.outputs[0], glass.inputs["IOR"])
    tree.links.new(glass.outputs[0], surface)
    ranged.data_type = "FLOAT_VECTOR"
    assert not ranged.outputs[0].enabled
    scene, _ = blender.export()
    assert [lobe.ior for lobe in scene.objects[0].materials[0].lobes] == [pytest.approx(1.3)]


@pytest.mark.parametrize("size", [1e-30, 1e30])
def test_a_normal_of_any_length_is_a_direction(size):
    """Found by chance: the square of 1e30 is beyond single precision, and the normal was 0."""

    def seen(size):
        _, tree, surface = stage()
        mapping = blender.add_node(tree, "ShaderNodeMapping", Location=(0.0, 0.3 * size, size), Scale=(0.0, 0.0, 0.0))
        diffuse = blender.add_node(tree, "ShaderNodeBsdfDiffuse")
        tree.links.new(mapping.outputs[0], diffuse.inputs["Normal"])
        tree.links.new(diffuse.outputs[0], surface)
        return picture(blender.export()[0])

    np.testing.assert_allclose(seen(size), seen(1.0), rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize(("ior", "used"), [(-3.0, 0.001), (0.0, 0.001), (1e6, 1000.0), (1.5, 1.5)])
@pytest.mark.parametrize("name", ["ShaderNodeBsdfGlass", "ShaderNodeBsdfPrincipled"])
def test_an_index_of_refraction_beyond_all_reason_is_cut_off_and_said(name, ior, used):
    _, tree, surface = stage()
    node = blender.add_node(tree, name, IOR=ior)
    if name.endswith("Principled"):
        blender.node_input(node, "Transmission Weight").default_value = 1
    blender.node_input(node, "Roughness").default_value = 0
    tree.links.new(node.outputs[0], surface)
    scene, warnings = blender.export()
    (found,) = (lobe.ior for lobe in scene.objects[0].materials[0].lobes if isinstance(lobe, Dielectric))
    assert found == used
    assert any("IOR" in line for line in warnings) == (ior != used)


@pytest.mark.parametrize("name", SHADERS)
def test_no_shader_is_pink_and_one_that_is_not_known_is_named(name):
    _, tree, surface = stage()
    node = tree.nodes.new(name)
    tree.links.new(next(s for s in node.outputs if s.type == "SHADER"), surface)
    scene, warnings = blender.export()
    red, green, blue = picture(scene)[..., :3].mean(axis=(0, 1))
    assert not (min(red, blue) > 2 * green and min(red, blue) > 0.1), (red, green, blue)
    assert is_known(node) or any(node.bl_label in line and "material 'Odd'" in line for line in warnings), warnings
