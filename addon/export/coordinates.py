"""What Blender's Vector inputs of textures mean: a source and an affine transform."""

import numpy as np
from mathutils import Euler

from ...engine import Coordinates
from .nodes import input_by_identifier

_SOURCES = {"UV": "uv", "Generated": "generated", "Object": "object"}
_LABELS = {"uv": "UV", "generated": "Generated"}


def coordinates_of(reader, node, default, scale=1.0):
    """The `Coordinates` that feed the Vector input of a texture node, times `scale`; `default` is the source where nothing does."""
    matrix = np.diag((scale, scale, scale, 1.0))
    socket = input_by_identifier(node, "Vector")
    while True:
        reader, _, output = reader.source(socket)
        if output is None:
            return Coordinates(source=default, matrix=matrix)
        node = output.node
        if node.type == "MAPPING":
            matrix = matrix @ _mapping(reader, node)
            socket = input_by_identifier(node, "Vector")
            following = reader.beyond(node)
            if following is None or following.source(socket)[2] is None:
                # A Mapping node maps the value of its own input then: one point.
                return Coordinates(source=default, matrix=matrix @ _to_point(getattr(socket, "default_value", (0, 0, 0))))
            reader = following
        elif node.type == "UVMAP":
            return Coordinates(source="uv", layer=node.uv_map, matrix=matrix)
        elif node.type == "TEX_COORD" and output.identifier in _SOURCES:
            if output.identifier == "Object" and node.object is not None:
                reader.note("Texture Coordinate of another object is taken from the object itself")
            return Coordinates(source=_SOURCES[output.identifier], matrix=matrix)
        else:
            reader.note(f"{output.name} of {node.bl_label} is not supported as texture coordinates, {_LABELS[default]} is used")
            return Coordinates(source=default, matrix=matrix)


def _mapping(reader, node):
    """(4, 4) of a Mapping node, whatever it says it maps."""
    location, rotation, scale = (np.array(reader.colour(node, identifier)) for identifier in ("Location", "Rotation", "Scale"))
    turn = np.array(Euler(rotation, "XYZ").to_matrix(), np.float64)
    result = np.eye(4)
    if node.vector_type == "TEXTURE":
        # The inverse of a point's transform; what is scaled by 0 has none, and stays 0 as in Blender.
        inverse = np.divide(1, scale, out=np.zeros(3), where=scale != 0)
        result[:3, :3] = inverse[:, None] * turn.T
        result[:3, 3] = -result[:3, :3] @ location
        return result
    if node.vector_type == "NORMAL":
        reader.note("Mapping of type Normal does not make its vectors unit")
        scale = np.divide(1, scale, out=np.zeros(3), where=scale != 0)
    result[:3, :3] = turn * scale
    if node.vector_type == "POINT":
        result[:3, 3] = location
    return result


def _to_point(p):
    """(4, 4) that takes everything to the point p."""
    result = np.zeros((4, 4))
    result[:3, 3] = tuple(p)[:3]
    result[3, 3] = 1
    return result
