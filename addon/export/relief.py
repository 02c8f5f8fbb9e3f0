"""Blender's Bump and Normal Map nodes as the engine's reliefs."""

from ...engine import BumpMap, NormalMap
from .colours import as_texture, varies
from .nodes import input_by_identifier


def relief_of(reader, node):
    """The reliefs that feed the Normal input of a shader node, a tuple, first to last; notes what is not one."""
    socket = input_by_identifier(node, "Normal")
    if socket is None or not reader.has_points:
        return ()
    behind, _, output = reader.source(socket)
    if output is None:
        return ()
    read = _TABLE.get(output.node.type)
    if read is None:
        reader.note(f"{output.node.bl_label} is not supported as a normal and is left out")
        return ()
    inside = behind.beyond(output.node)
    return () if inside is None else read(inside, output.node)


def _bump(reader, node):
    below = relief_of(reader, node)
    height = as_texture(reader.value(node, "Height"))
    if not varies(height):
        # What is equally high everywhere is flat.
        return below
    distance = reader.number(node, "Distance", 1.0)
    strength = max(reader.number(node, "Strength", 1.0), 0.0)
    return (*below, BumpMap(height, -distance if node.invert else distance, strength))


def _normal_map(reader, node):
    colour = as_texture(reader.value(node, "Color"))
    if node.space != "TANGENT":
        reader.note(f"Normal Map in {node.space.lower()} space is left out, only tangent space is supported")
        return ()
    if getattr(node, "convention", "OPENGL") != "OPENGL":
        reader.note("Normal Map with another convention than OpenGL is read as OpenGL")
    return (NormalMap(colour, max(reader.number(node, "Strength", 1.0), 0.0), node.uv_map),)


_TABLE = {"BUMP": _bump, "NORMAL_MAP": _normal_map}
