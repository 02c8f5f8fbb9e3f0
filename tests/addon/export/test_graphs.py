"""Node trees that share their parts, and node trees without an end."""

import bpy
import pytest

from glanz.addon.export import nodes, values
from glanz.engine import BrickTexture, NoiseTexture, Settings, render_image
from glanz.engine.scene.graphs import with_inner
from glanz.tests.addon import blender

_MIXES = 60
"""If each were read twice where it is used twice, no machine would see the end."""


def chain(kind, first, socket_type, count):
    """A plane whose material feeds `count` nodes of a kind, each into both inputs of the next one, the first by the node `first`."""
    material = bpy.data.materials.new("Deep")
    tree = blender.new_nodes(material)
    output = tree.nodes.new(first).outputs[0]
    for _ in range(count):
        node = tree.nodes.new(kind)
        for socket in [s for s in node.inputs if s.type == socket_type][-2:] if socket_type == "SHADER" else node.inputs[:2]:
            tree.links.new(output, socket)
        output = node.outputs[0]
    if output.type != "SHADER":
        shader = tree.nodes.new("ShaderNodeEmission")
        tree.links.new(output, shader.inputs["Color"])
        output = shader.outputs[0]
    tree.links.new(output, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    blender.add_plane().data.materials.append(material)
    scene, warnings = blender.export()
    return scene.objects[0].materials[0], warnings


def test_a_shader_that_is_mixed_with_itself_again_and_again_stays_one():
    material, warnings = chain("ShaderNodeMixShader", "ShaderNodeBsdfDiffuse", "SHADER", _MIXES)
    assert warnings == ()
    (lobe,) = material.lobes
    assert lobe.reflectance == pytest.approx((0.8,) * 3)


def test_a_value_that_feeds_both_inputs_again_and_again_is_read_once():
    material, warnings = chain("ShaderNodeMath", "ShaderNodeTexNoise", "VALUE", _MIXES)
    assert warnings == ()
    assert sum(type(part) is NoiseTexture for part in with_inner(material.emission)) == 1
    assert len(with_inner(material.emission)) <= _MIXES + 3


@pytest.mark.parametrize(
    ("kind", "first", "socket_type"),
    [("ShaderNodeMath", "ShaderNodeTexNoise", "VALUE"), ("ShaderNodeMixShader", "ShaderNodeBsdfDiffuse", "SHADER")],
)
def test_what_is_deeper_than_allowed_is_cut_off_and_named(kind, first, socket_type, monkeypatch, tmp_path):
    monkeypatch.setattr(nodes, "DEEPEST", 100)
    _, warnings = chain(kind, first, socket_type, 120)
    assert any("more than 100 deep" in line and "material 'Deep'" in line for line in warnings)
    assert blender.read_exr(blender.render(tmp_path / "deep.exr"))


def test_what_is_deeper_than_the_stack_is_read_and_rendered():
    """Python stops after 1,000 frames; a Brick Texture that feeds the next one takes nine of them to be read, and four to be looked up."""
    material, warnings = chain("ShaderNodeTexBrick", "ShaderNodeTexNoise", "VALUE", 160)
    assert warnings == ()
    assert sum(type(part) is BrickTexture for part in with_inner(material.emission)) == 160
    scene, _ = blender.export()
    assert render_image(scene, Settings(width=4, height=4, samples=1, threads=1)).warnings == ()


def test_shaders_mixed_by_textures_are_rendered_however_many():
    """Each mix scales the colours of all that were mixed before it by one more texture."""
    tree = blender.new_nodes(bpy.data.materials.new("Deep"))
    first = tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0]
    for _ in range(150):
        node = tree.nodes.new("ShaderNodeMixShader")
        tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], node.inputs[0])
        tree.links.new(first, node.inputs[1])
        first = node.outputs[0]
    tree.links.new(first, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    blender.add_plane().data.materials.append(bpy.data.materials["Deep"])
    scene, warnings = blender.export()
    assert warnings == ()
    assert render_image(scene, Settings(width=4, height=4, samples=1, threads=1)).warnings == ()


def glowing_plane(name):
    """(tree, the Strength of its Emission) of a material on a plane."""
    material = blender.new_material(name, "ShaderNodeEmission")
    blender.add_plane().data.materials.append(material)
    return material.node_tree, next(node for node in material.node_tree.nodes if node.type == "EMISSION").inputs["Strength"]


def new_group(name):
    """A node group with one input and one output, numbers, and the nodes that stand for them."""
    group = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Value", in_out=in_out, socket_type="NodeSocketFloat")
    return group, group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")


def group_node(tree, group):
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    return node


def nested(depth, copies):
    """A group that adds 1 to its input; in so many groups, each of which adds up `copies` of the one before."""
    group, start, end = new_group("Innermost")
    add = group.nodes.new("ShaderNodeMath")
    add.inputs[1].default_value = 1
    group.links.new(start.outputs[0], add.inputs[0])
    group.links.new(add.outputs[0], end.inputs[0])
    for i in range(depth):
        inner, (group, start, end) = group, new_group(f"Group {i}")
        found = []
        for _ in range(copies):
            found.append(group_node(group, inner))
            group.links.new(start.outputs[0], found[-1].inputs[0])
        last = found[0]
        for other in found[1:]:
            add = group.nodes.new("ShaderNodeMath")
            group.links.new(last.outputs[0], add.inputs[0])
            group.links.new(other.outputs[0], add.inputs[1])
            last = add
        group.links.new(last.outputs[0], end.inputs[0])
    return group


def test_groups_in_groups_in_groups_are_followed():
    tree, strength = glowing_plane("Nest")
    node = group_node(tree, nested(50, copies=1))
    node.inputs[0].default_value = 2
    tree.links.new(node.outputs[0], strength)
    scene, warnings = blender.export()
    assert warnings == ()
    assert scene.objects[0].materials[0].emission == (3.0, 3.0, 3.0)


def test_groups_that_are_used_twice_in_groups_that_are_used_twice_end_and_are_named(monkeypatch):
    """2^12 nodes (of more Blender itself does not see the end). Fewer than allowed are all counted: 2^4."""
    monkeypatch.setattr(values, "MOST", 500)
    tree, strength = glowing_plane("Nest")
    node = group_node(tree, nested(12, copies=2))
    tree.links.new(node.outputs[0], strength)
    _, warnings = blender.export()
    assert any("more than 500" in line and "material 'Nest'" in line for line in warnings)
    node.node_tree = bpy.data.node_groups["Group 3"]
    tree.links.new(node.outputs[0], strength)
    scene, warnings = blender.export()
    assert warnings == ()
    assert scene.objects[0].materials[0].emission == (16.0, 16.0, 16.0)


def circle(tree, kind, count, mute=False):
    """The output of `count` nodes of a kind that feed each other in a circle."""
    found = [tree.nodes.new(kind) for _ in range(count)]
    for node, following in zip(found, [*found[1:], found[0]]):
        node.mute = mute
        tree.links.new(node.outputs[0], following.inputs[0])
    return found[0].outputs[0]


@pytest.mark.parametrize(("kind", "mute"), [("ShaderNodeMath", False), ("ShaderNodeMath", True), ("NodeReroute", False)])
@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("in_group", [False, True])
def test_circles_are_cut_off_and_named(kind, mute, count, in_group):
    tree, strength = glowing_plane("Round")
    if in_group:
        group, _, end = new_group("Group")
        group.links.new(circle(group, kind, count, mute), end.inputs[0])
        tree.links.new(group_node(tree, group).outputs[0], strength)
    else:
        tree.links.new(circle(tree, kind, count, mute), strength)
    scene, warnings = blender.export()
    assert any("circle" in line and "material 'Round'" in line for line in warnings)
    assert render_image(scene, Settings(width=4, height=4, samples=1, threads=1)).warnings == ()


def test_a_circle_through_a_group_and_back_is_cut_off_and_named():
    tree, strength = glowing_plane("Round")
    node = group_node(tree, nested(1, copies=1))
    tree.links.new(node.outputs[0], node.inputs[0])
    tree.links.new(node.outputs[0], strength)
    _, warnings = blender.export()
    assert any("circle" in line and "material 'Round'" in line for line in warnings)


@pytest.mark.parametrize("is_diamond", [False, True])
def test_volumes_are_read_however_deep_and_once(is_diamond):
    """A chain of 700 would be too deep for Python, and a diamond of 40 too wide for anything."""
    blender.add_camera()
    material = bpy.data.materials.new("Fog")
    tree = blender.new_nodes(material)
    last = blender.add_node(tree, "ShaderNodeVolumeAbsorption", Density=1e-3, Color=(0, 0, 0, 1)).outputs[0]
    for _ in range(40 if is_diamond else 700):
        add = tree.nodes.new("ShaderNodeAddShader")
        for socket in add.inputs if is_diamond else add.inputs[:1]:
            tree.links.new(last, socket)
        last = add.outputs[0]
    tree.links.new(last, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Volume"])
    blender.add_plane().data.materials.append(material)
    scene, warnings = blender.export()
    density = scene.objects[0].materials[0].medium.absorption
    assert density == pytest.approx((1e-3 * 2**40 if is_diamond else 1e-3,) * 3)
    assert warnings == ()
