"""Nodes that compute with numbers and vectors."""

from dataclasses import replace

import bpy
import numpy as np
from mathutils import Euler

from ...engine import Clamp, Coordinates, Mapping, MapRange, Math, Mix, MixColour, RadialTiling, VectorMath, VectorRotate
from .colours import varies
from .nodes import words

_OLD_NUMBERS, _OLD_TRIPLES = ("power",), ("power", "wrap")


def _operands(reader, node):
    """The values of the inputs that the node's mode has, in their order."""
    return [reader.value_of(socket) for socket in node.inputs if socket.enabled]


def _math(reader, node, output):
    return Math(*_padded(_operands(reader, node), 0.0), _operation(node, _OLD_NUMBERS), node.use_clamp)


def _vector_math(reader, node, output):
    return VectorMath(*_padded(_operands(reader, node), (0.0, 0.0, 0.0)), _operation(node, _OLD_TRIPLES))


def _operation(node, old):
    """The engine's name of the operation of a node; those in `old` were others before Blender 5.0."""
    operation = words(node.operation)
    return f"{operation} before 5.0" if bpy.app.version < (5, 0) and operation in old else operation


def _padded(values, nothing):
    return (*values, nothing, nothing)[:3]


def _mix(reader, node, output):
    inputs = _operands(reader, node)
    if node.data_type == "RGBA":
        return MixColour(*inputs, words(node.blend_type), node.clamp_factor, node.clamp_result)
    if node.data_type in ("FLOAT", "VECTOR"):
        return Mix(*inputs, node.clamp_factor)
    return None


def _clamp(reader, node, output):
    return Clamp(*_operands(reader, node), node.clamp_type == "RANGE")


def _map_range(reader, node, output):
    is_number, interpolation = node.data_type == "FLOAT", words(node.interpolation_type)
    inputs = _operands(reader, node)
    steps = inputs[5] if len(inputs) > 5 else 0.0
    # Blender shows no switch for eased ranges, which are limited by themselves.
    is_clamped = node.clamp and (is_number or interpolation in ("linear", "stepped"))
    return MapRange(*inputs[:5], steps, interpolation, is_clamped, is_number)


def _vector_rotate(reader, node, output):
    kind = node.rotation_type
    axis = {"X_AXIS": (1.0, 0.0, 0.0), "Y_AXIS": (0.0, 1.0, 0.0), "Z_AXIS": (0.0, 0.0, 1.0)}.get(kind)
    if axis is None:
        axis = reader.value(node, "Rotation" if kind == "EULER_XYZ" else "Axis")
    inputs = reader.value(node, "Vector"), reader.value(node, "Center"), axis, reader.value(node, "Angle")
    return VectorRotate(*inputs, kind == "EULER_XYZ", node.invert)


def _radial_tiling(reader, node, output):
    inputs = (reader.value(node, identifier) for identifier in ("Vector", "Sides", "Roundness"))
    return RadialTiling(*inputs, _TILING[output], node.normalize)


_TILING = {"Segment Coordinates": "coordinates", "Segment ID": "number", "Segment Width": "width", "Segment Rotation": "rotation"}


def _mapping(reader, node, output):
    vector, *changes = (reader.value(node, identifier) for identifier in ("Vector", "Location", "Rotation", "Scale"))
    is_affine = isinstance(vector, Coordinates) and node.vector_type != "NORMAL" and not any(map(varies, changes))
    # Coordinates stay coordinates, whose footprints are known exactly.
    if is_affine:
        return replace(vector, matrix=_matrix(node.vector_type, *map(np.array, changes)) @ np.array(vector.matrix))
    return Mapping(vector, *changes, words(node.vector_type))


def _matrix(kind, location, rotation, scale):
    """(4, 4) of a Mapping node of type point, texture or vector."""
    turn = np.array(Euler(rotation, "XYZ").to_matrix(), np.float64)
    result = np.eye(4)
    if kind == "TEXTURE":
        # The inverse of a point's transform; what is scaled by 0 has none, and stays 0 as in Blender.
        inverse = np.divide(1, scale, out=np.zeros(3), where=scale != 0)
        result[:3, :3] = inverse[:, None] * turn.T
        result[:3, 3] = -result[:3, :3] @ location
        return result
    result[:3, :3] = turn * scale
    if kind == "POINT":
        result[:3, 3] = location
    return result


TABLE = {
    "MATH": _math,
    "VECT_MATH": _vector_math,
    "MIX": _mix,
    "CLAMP": _clamp,
    "MAP_RANGE": _map_range,
    "VECTOR_ROTATE": _vector_rotate,
    "MAPPING": _mapping,
    "ShaderNodeRadialTiling": _radial_tiling,
}
