"""Nothing is found by a name that users or translations of Blender may change: what is renamed exports the same, to the bit."""

import bpy
from hypothesis import given, note, strategies as st

from glanz.addon.persistent import is_same
from glanz.tests.addon import blender
from glanz.tests.addon.export import trees
from glanz.tests.addon.export.test_random_trees import NODES, stage, told
from glanz.tests.chance import law


@given(st.data())
@law(quick=60, thorough=1000)
def test_names_in_any_tree_mean_nothing(data):
    _, tree, surface = stage()
    trees.grow(data.draw, tree, surface, NODES, trees.DEPTH, trees.EVEN)
    note(told(tree))
    scene, warnings = blender.export()
    trees.rename_all()
    again, warnings_again = blender.export()
    assert is_same(scene, again)
    assert trees.nameless(warnings) == trees.nameless(warnings_again)


def grouped(colours):
    """A group that mixes two emissions half and half, of which it is given the colours; in another group that only passes them on."""
    inner, outer = (bpy.data.node_groups.new(name, "ShaderNodeTree") for name in ("Inner", "Outer"))
    ends = []
    for group in (inner, outer):
        for name, kind, way in (("A", "NodeSocketColor", "INPUT"), ("B", "NodeSocketColor", "INPUT"), ("C", "NodeSocketShader", "OUTPUT")):
            group.interface.new_socket(name, in_out=way, socket_type=kind)
        ends.append((group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")))
    (start, end), (outer_start, outer_end) = ends
    mix = inner.nodes.new("ShaderNodeMixShader")
    for i in range(2):
        emission = inner.nodes.new("ShaderNodeEmission")
        inner.links.new(start.outputs[i], emission.inputs[0])
        inner.links.new(emission.outputs[0], mix.inputs[1 + i])
    inner.links.new(mix.outputs[0], end.inputs[0])
    nested = outer.nodes.new("ShaderNodeGroup")
    nested.node_tree = inner
    # Crossed, so that a mistake shows.
    outer.links.new(outer_start.outputs[0], nested.inputs[1])
    outer.links.new(outer_start.outputs[1], nested.inputs[0])
    outer.links.new(nested.outputs[0], outer_end.inputs[0])
    _, tree, surface = stage()
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = outer
    for socket, colour in zip(node.inputs, colours):
        socket.default_value = colour
    tree.links.new(node.outputs[0], surface)
    # Where they differ in strength it matters which is which.
    next(n for n in inner.nodes if n.type == "EMISSION").inputs[1].default_value = 4.0


def test_sockets_of_groups_may_share_one_name():
    grouped([(1, 0, 0, 1), (0, 1, 0, 1)])
    trees.rename_all()
    (material,) = (m for o in blender.export()[0].objects for m in o.materials)
    # Half of the first inner emission, which is the outer group's second colour, four times as strong.
    assert material.emission == (0.5, 2.0, 0.0)
