"""Nodes that say what is known of a point: its coordinates, its object, the ray that met it."""

from ...engine import Coordinates

_SOURCES = {"UV": "uv", "Generated": "generated", "Object": "object"}


def _texture_coordinates(reader, node, output):
    if output not in _SOURCES:
        reader.note(f"{output} of {node.bl_label} is not supported, Generated is used")
    if output == "Object" and node.object is not None:
        reader.note("Texture Coordinate of another object is taken from the object itself")
    return Coordinates(source=_SOURCES.get(output, "generated"))


def _uv_map(reader, node, output):
    return Coordinates(source="uv", layer=node.uv_map)


TABLE = {"TEX_COORD": _texture_coordinates, "UVMAP": _uv_map}
