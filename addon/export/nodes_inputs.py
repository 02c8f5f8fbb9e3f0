"""Nodes that say what is known of a point: its coordinates, its mesh and object, the ray that met it."""

import bpy
import numpy as np

from ...engine import (
    Attribute,
    BumpMap,
    CameraData,
    Coordinates,
    Fresnel,
    Geometry,
    LayerWeight,
    LightPath,
    NormalDot,
    NormalMap,
    ObjectValue,
    Tangent,
    VectorTransform,
    Wireframe,
)
from .attributes import DEFAULT_COLOUR, ISLAND, POINTINESS
from .colours import varies
from .findings import IGNORED

_NORMAL = Geometry("normal")


def _texture_coordinates(reader, node, output):
    if node.from_instancer and output in ("Generated", "UV"):
        return ObjectValue(f"instancer {output.lower()}")
    if output == "Object" and node.object is not None:
        # Of what is flattened, the inverse that leads back into its plane.
        return Coordinates(source="position", matrix=np.linalg.pinv(np.array(node.object.matrix_world, np.float64)))
    if output == "Normal":
        return Geometry("object normal")
    if output == "Reflection":
        return Geometry("reflection")
    return CameraData("window") if output == "Window" else Coordinates(source=output.lower())


def _uv_map(reader, node, output):
    return ObjectValue("instancer uv") if node.from_instancer else Coordinates(source="uv", layer=node.uv_map)


def _geometry(reader, node, output):
    if output == "Position":
        return Coordinates(source="position")
    if output == "Tangent":
        return Tangent("z")
    if output == "Pointiness":
        return Attribute(POINTINESS, "number")
    return Attribute(ISLAND, "number") if output == "Random Per Island" else Geometry(output.lower())


def _object_info(reader, node, output):
    if output == "Material Index":
        return float(getattr(_material_of(reader, node), "pass_index", 0))
    name = {"Location": "location", "Object Index": "index", "Random": "random"}.get(output, "colour")
    kind = {"Location": "colour", "Color": "colour", "Alpha": "alpha"}.get(output, "number")
    return ObjectValue(name, kind)


def _material_of(reader, node):
    """The material that the nodes of `reader` are in, which trees do not tell; None where they are in something else."""
    tree = (reader.groups[0] if reader.groups else node).id_data.original
    return next((material for material in bpy.data.materials if material.node_tree == tree), None)


def _particle_info(reader, node, output):
    is_vector = output in ("Location", "Velocity", "Angular Velocity")
    return ObjectValue(f"particle {output.lower()}", "colour" if is_vector else "number")


_OWNERS = {"OBJECT": "object", "INSTANCER": "instancer", "VIEW_LAYER": "layer"}


def _attribute(reader, node, output):
    owner = _OWNERS.get(node.attribute_type)
    if owner:
        return ObjectValue(f"{owner} {node.attribute_name}", {"Fac": "mean", "Alpha": "alpha"}.get(output, "colour"))
    if not node.attribute_name:
        return 1.0 if output == "Alpha" else 0.0 if output == "Fac" else (0.0, 0.0, 0.0)
    return Attribute(node.attribute_name, {"Fac": "number", "Alpha": "alpha"}.get(output, "colour"))


def _colour_attribute(reader, node, output):
    return Attribute(node.layer_name or DEFAULT_COLOUR, "opacity" if output == "Alpha" else "colour")


def _normal_of(reader, node):
    """What feeds the Normal of a node; None: the shading normal."""
    return reader.vector(node, None, "Normal")


def _fresnel(reader, node, output):
    return Fresnel(reader.value(node, "IOR", 1.5), _normal_of(reader, node))


def _layer_weight(reader, node, output):
    return LayerWeight(reader.value(node, "Blend", 0.5), _normal_of(reader, node), output.lower())


def _light_path(reader, node, output):
    if output in ("Is Volume Scatter Ray", "Portal Depth"):
        return 0.0
    return LightPath(output.removeprefix("Is ").removesuffix(" Ray").removeprefix("Ray ").lower())


def _camera(reader, node, output):
    return CameraData({"View Vector": "vector", "View Z Depth": "depth", "View Distance": "distance"}[output])


def _ambient_occlusion(reader, node, output):
    reader.note("Ambient Occlusion is 1 everywhere, nothing is darkened by what is near", IGNORED)
    return 1.0 if output == "AO" else reader.value(node, "Color", (1.0, 1.0, 1.0))


def _bevel(reader, node, output):
    reader.note("Bevel does not round edges, it is the normal of the surface", IGNORED)
    return _normal_of(reader, node) or _NORMAL


def _tangent(reader, node, output):
    return Tangent("uv", node.uv_map) if node.direction_type == "UV_MAP" else Tangent(node.axis.lower())


def _normal(reader, node, output):
    direction = np.array(next(s for s in node.outputs if s.identifier == "Normal").default_value, np.float64)
    direction = tuple((direction / (np.linalg.norm(direction) or 1)).tolist())
    return direction if output == "Normal" else NormalDot(reader.value(node, "Normal"), direction)


def _vector_transform(reader, node, output):
    spaces = node.convert_from.lower(), node.convert_to.lower()
    return VectorTransform(reader.value(node, "Vector", (0.5, 0.5, 0.5)), node.vector_type.lower(), *spaces)


def _wireframe(reader, node, output):
    return Wireframe(reader.value(node, "Size", 0.01), node.use_pixel_size)


def _absent(reader, node, output):
    reader.note(f"{node.bl_label} knows nothing of meshes, it is 0")
    kind = next(socket.type for socket in node.outputs if socket.identifier == output)
    return 0.0 if kind == "VALUE" else (0.0, 0.0, 0.0)


_LEAST_WIDTH = 2.0**-10
"""Of a pixel; Blender allows 0, which compares heights with themselves."""


def _bump(reader, node, output):
    height, normal = reader.value(node, "Height"), _normal_of(reader, node)
    if not varies(height):
        # What is equally high everywhere is flat.
        return normal or _NORMAL
    # Versions without the socket compare heights a pixel apart.
    width = max(reader.number(node, "Filter Width", 1.0), _LEAST_WIDTH)
    return BumpMap(height, reader.value(node, "Distance", 1.0), reader.value(node, "Strength", 1.0), normal, bool(node.invert), width)


def _normal_map(reader, node, output):
    return NormalMap(
        reader.value(node, "Color", (0.5, 0.5, 1.0)),
        reader.value(node, "Strength", 1.0),
        node.uv_map,
        node.space.lower().replace("_", " "),
        getattr(node, "convention", "OPENGL") == "DIRECTX",
    )


TABLE = {
    "TEX_COORD": _texture_coordinates,
    "UVMAP": _uv_map,
    "NEW_GEOMETRY": _geometry,
    "OBJECT_INFO": _object_info,
    "PARTICLE_INFO": _particle_info,
    "ATTRIBUTE": _attribute,
    "VERTEX_COLOR": _colour_attribute,
    "FRESNEL": _fresnel,
    "LAYER_WEIGHT": _layer_weight,
    "LIGHT_PATH": _light_path,
    "CAMERA": _camera,
    "AMBIENT_OCCLUSION": _ambient_occlusion,
    "BEVEL": _bevel,
    "TANGENT": _tangent,
    "NORMAL": _normal,
    "VECT_TRANSFORM": _vector_transform,
    "WIREFRAME": _wireframe,
    "HAIR_INFO": _absent,
    "POINT_INFO": _absent,
    "VOLUME_INFO": _absent,
    "BUMP": _bump,
    "NORMAL_MAP": _normal_map,
}
