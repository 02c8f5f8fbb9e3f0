"""Random node trees, drawn by Hypothesis: any node that Blender offers, in any mode, fed by any other."""

import warnings
from math import inf

import bpy
from hypothesis import strategies as st

from glanz.tests.addon import blender

DEPTH = 6
"""Nodes between the output and the last one, at most."""
ODD = st.sampled_from((0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 7.3, -3.7, 1e-30, 1e6, -1e6, 1e30, -1e30, inf, -inf))
EVEN = st.sampled_from((0.0, 0.2, 0.5, 0.7, 1.0))
JUNK = "Größe.001 名前 \N{SNOWMAN}"
"""A name that Glanz does not know."""
_GLOWS = ("ShaderNodeEmission", "ShaderNodeBackground", "ShaderNodeEeveeSpecular")
_MODES = ("ENUM", "BOOLEAN")


def offered():
    """(names of shaders, names of nodes that make values): all that Blender offers for materials, groups excluded."""
    shaders, values = [], []
    tree = blender.new_nodes(bpy.data.materials.new("Scratch"))
    with warnings.catch_warnings(action="ignore"):
        names = [name for name in sorted(dir(bpy.types)) if name.startswith("ShaderNode") and "Group" not in name]
    for name in names:
        try:
            node = tree.nodes.new(name)
        except RuntimeError:
            # A base class, or one that this version keeps for files only.
            continue
        if node.outputs:
            (shaders if any(s.type == "SHADER" for s in node.outputs) else values).append(name)
    return shaders, values


def grow(draw, tree, socket, nodes, depth, number=ODD):
    """Feed `socket` with a random tree of at most `depth` nodes one behind the other; `number`s are its constants."""
    shaders, values = nodes
    node = tree.nodes.new(draw(st.sampled_from(shaders if socket.type == "SHADER" else values)))
    _into_any_mode(draw, node)
    inputs = [s for s in node.inputs if s.enabled and not s.is_unavailable]
    for child in inputs:
        if child.type == "SHADER":
            if depth > 1:
                grow(draw, tree, child, nodes, depth - 1, number)
        elif child.type in ("VALUE", "RGBA", "VECTOR") and draw(st.booleans()):
            _fill(draw, child, number)
    fed = [s for s in inputs if s.type in ("VALUE", "RGBA", "VECTOR")]
    for child in draw(st.lists(st.sampled_from(fed), max_size=2, unique=True)) if fed and depth > 1 else ():
        grow(draw, tree, child, nodes, depth - 1, number)
    outputs = [s for s in node.outputs if s.enabled and not s.is_unavailable and (s.type == "SHADER") == (socket.type == "SHADER")]
    if outputs:
        tree.links.new(draw(st.sampled_from(outputs)), socket)
        node.mute = draw(st.integers(0, 15)) == 15


def _into_any_mode(draw, node):
    inherited = bpy.types.ShaderNode.bl_rna.properties
    for name, p in node.bl_rna.properties.items():
        if name in inherited or p.type not in _MODES or p.is_readonly or getattr(p, "is_array", False) or getattr(p, "is_enum_flag", False):
            continue
        choices = [e.identifier for e in p.enum_items] if p.type == "ENUM" else [False, True]
        if not choices or not draw(st.booleans()):
            continue
        try:
            setattr(node, name, draw(st.sampled_from(choices)))
        except TypeError:
            # An item that the menu shows for another mode only.
            continue


def _fill(draw, socket, number):
    if socket.type == "VALUE":
        socket.default_value = draw(number)
    else:
        for i in range(min(len(socket.default_value), 3)):
            socket.default_value[i] = draw(number)


def without_glow(shaders):
    """The shaders that send on what arrives, and make no light of their own."""
    return [name for name in shaders if name not in _GLOWS]


def black_glow(tree):
    """No light comes out of shaders that glow beside what they reflect."""
    for node in tree.nodes:
        strength = blender.node_input(node, "Emission Strength") if node.bl_idname == "ShaderNodeBsdfPrincipled" else None
        if strength is not None:
            for link in list(strength.links):
                tree.links.remove(link)
            strength.default_value = 0


def rename(tree):
    """Call everything in it JUNK, as far as Blender lets two things have one name."""
    for node in tree.nodes:
        node.name = node.label = JUNK
        for socket in (*node.inputs, *node.outputs):
            socket.name = JUNK
    for item in tree.interface.items_tree if tree.interface else ():
        item.name = JUNK


def rename_all():
    """The same for all node trees of the open file: of materials, worlds and lights, and groups."""
    for owner in (*bpy.data.materials, *bpy.data.worlds, *bpy.data.lights):
        if owner.node_tree:
            rename(owner.node_tree)
    for group in bpy.data.node_groups:
        group.name = JUNK
        rename(group)
    bpy.context.view_layer.update()


def nameless(lines):
    """Warnings without the names of the nodes that they are about."""
    return [line.partition(": node ")[0] for line in lines]
