"""Blender's evaluated meshes as the engine's, by bulk copies only."""

import numpy as np

from ...engine import Mesh


def export_mesh(mesh, name):
    """The engine's `Mesh` for an evaluated `bpy.types.Mesh`, in object space; its arrays are copies."""
    triangles = mesh.loop_triangles
    if not len(triangles):
        mesh.calc_loop_triangles()
        triangles = mesh.loop_triangles
    flat = is_flat(mesh)
    return Mesh(
        name=name,
        vertices=vertices(mesh),
        triangles=_columns(triangles, "vertices", np.int32),
        normals=np.zeros((3, 0)) if flat else corner_normals(mesh),
        normal_indices=np.zeros((3, 0)) if flat else _columns(triangles, "loops", np.int32),
        material_indices=material_indices(triangles),
    )


def vertices(mesh):
    """(3, V) float32 [m]."""
    return _columns(mesh.vertices, "co", np.float32)


def corner_normals(mesh):
    """(3, L) float32, a normal for each corner of each face."""
    return _columns(mesh.corner_normals, "vector", np.float32)


def corners(mesh):
    """(L,) the vertex of each corner of each face: what the mesh is made of, whatever its shape."""
    result = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", result)
    return result


def is_flat(mesh):
    """Whether every face is shaded by its own geometric normal."""
    return mesh.normals_domain == "FACE" and not mesh.has_custom_normals


def material_indices(triangles):
    """(F,) indices of material slots, or (0,) where all are the first; Geometry Nodes can store negative ones, which count as 0."""
    indices = np.empty(len(triangles), np.int32)
    triangles.foreach_get("material_index", indices)
    return np.maximum(indices, 0) if indices.any() else np.zeros(0, np.int32)


def _columns(collection, attribute, dtype):
    """The three-component `attribute` of a collection as (3, N)."""
    flat = np.empty(3 * len(collection), dtype)
    collection.foreach_get(attribute, flat)
    return np.ascontiguousarray(flat.reshape(-1, 3).T)
