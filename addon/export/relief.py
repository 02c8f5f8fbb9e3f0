"""What bends the normals of Blender's shaders, as the engine's reliefs."""

from ...engine import BumpMap, Geometry, LinearTexture
from .colours import added, as_texture, times, varies
from .findings import IGNORED
from .nodes import input_by_identifier


def relief_of(reader, node):
    """What feeds the Normal input of a shader node, as a tuple of one relief, or of none."""
    if not reader.has_points:
        return ()
    normal = reader.vector(node, None, "Normal")
    if normal is None or (isinstance(normal, Geometry) and normal.output == "normal"):
        return ()
    return (as_texture(normal) if varies(normal) else LinearTexture(offset=normal),)


def displacement_of(reader, output):
    """What feeds the Displacement of a material's output node, as a tuple of one relief, or of none."""
    reader, _, end = reader.source(input_by_identifier(output, "Displacement"))
    if end is None or not reader.has_points:
        return ()
    inside = reader.beyond(end.node)
    read = _HEIGHTS.get(end.node.type)
    if inside is None or read is None:
        (inside or reader).note("displacement by other nodes than Displacement and Vector Displacement is left out", IGNORED)
        return ()
    inside.note("displacement is rendered as bump, outlines and shadows stay as they are")
    height = read(inside, end.node)
    return (BumpMap(as_texture(height), 1.0),) if varies(height) else ()


def _height(reader, node):
    return times(added(reader.value(node, "Height"), -reader.number(node, "Midlevel", 0.5)), reader.value(node, "Scale", 1.0))


def _height_of_vector(reader, node):
    shifted = added(reader.value(node, "Vector", (0.0, 0.0, 0.0)), -reader.number(node, "Midlevel"))
    vector = times(shifted, reader.value(node, "Scale", 1.0))
    if not varies(vector):
        return vector
    # Heights are the mean of three components. The second of tangent space is that along the normal.
    along = (0.0, 3.0, 0.0) if node.space == "TANGENT" else LinearTexture((Geometry("true normal"),), (3.0,))
    return LinearTexture((as_texture(vector),), (along,))


_HEIGHTS = {"DISPLACEMENT": _height, "VECTOR_DISPLACEMENT": _height_of_vector}
