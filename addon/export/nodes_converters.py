"""Nodes that compute with numbers and vectors."""

from dataclasses import replace

import numpy as np
from mathutils import Euler

from ...engine import Coordinates


def _mapping(reader, node, output):
    vector = reader.value(node, "Vector")
    if not isinstance(vector, Coordinates):
        reader.note("Mapping of what is no plain texture coordinates is left out")
        return vector
    return replace(vector, matrix=_matrix(reader, node) @ np.array(vector.matrix))


def _matrix(reader, node):
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


TABLE = {"MAPPING": _mapping}
