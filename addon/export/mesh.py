"""Blender's evaluated meshes as the engine's, by bulk copies only."""

from contextlib import contextmanager

import numpy as np

from ...engine import Mesh
from .attributes import mesh_attributes


def export_mesh(mesh, name, attributes=(), groups=()):
    """The engine's `Mesh` for an evaluated `bpy.types.Mesh`, in object space; its arrays are copies.

    `attributes` are what textures are looked up at, as `Material.attributes` has them; others are left out. `groups` are
    the names of the vertex groups.
    """
    flat, loops = is_flat(mesh), triangle_corners(mesh)
    triangles = corners(mesh).take(loops)
    layers = uv_layers(mesh, [layer for source, layer in attributes if source in ("uv", "tangent")])
    names = {name for source, name in attributes if source in ("attribute", "number", "alpha", "colour alpha")}
    return Mesh(
        name=name,
        vertices=vertices(mesh),
        triangles=triangles,
        normals=np.zeros((3, 0)) if flat else normals(mesh),
        normal_indices=np.zeros((3, 0)) if flat else triangles if has_vertex_normals(mesh) else loops,
        material_indices=material_indices(mesh),
        uv_layers=[layer.name for layer in layers],
        uvs=_uvs(layers, len(mesh.loops)),
        uv_indices=loops if layers else np.zeros((3, 0)),
        generated=generated(mesh) if ("generated", "") in attributes else np.zeros((3, 0)),
        attributes=mesh_attributes(mesh, loops, names, groups),
    )


@contextmanager
def mesh_of(ob):
    """The mesh of an object (evaluated) whose data is one, while the block lasts."""
    if not ob.data.is_editmode:
        yield ob.data
        return
    # While it is edited, by whichever of the objects that share it, its data is elsewhere.
    try:
        yield ob.to_mesh()
    finally:
        ob.to_mesh_clear()


# Attributes are copied as they lie in memory, up to a hundred times faster than the same numbers of vertices, corners and faces.


def vertices(mesh):
    """(3, V) float32 [m]."""
    return _columns(mesh.attributes["position"].data, "vector", np.float32)


def has_vertex_normals(mesh):
    """Whether all corners that meet at a vertex have the same normal: every face is smooth, and no edge is sharp."""
    return mesh.normals_domain == "POINT" and not mesh.has_custom_normals


def normals(mesh):
    """(3, V) float32 of a mesh that `has_vertex_normals`, else (3, L), a normal for each corner of each face."""
    return _columns(mesh.vertex_normals if has_vertex_normals(mesh) else mesh.corner_normals, "vector", np.float32)


def corners(mesh):
    """(L,) the vertex of each corner of each face: what the mesh is made of, whatever its shape."""
    result = np.empty(len(mesh.loops), np.int32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", result)
    return result


def triangle_corners(mesh):
    """(3, F) int32: which of the corners of the faces those of each triangle are."""
    if not len(mesh.loop_triangles):
        mesh.calc_loop_triangles()
    return _columns(mesh.loop_triangles, "loops", np.int32)


def uv_layers(mesh, names):
    """The layers of texture coordinates called `names`; no name is the layer for rendering, which comes first then."""
    if not names:
        return []
    layers = [layer for layer in mesh.uv_layers if layer.name in names or ("" in names and layer.active_render)]
    return sorted(layers, key=lambda layer: not layer.active_render)


def _uvs(layers, count):
    result = np.empty((len(layers), 2, count), np.float32)
    flat = np.empty(2 * count, np.float32)
    for values, layer in zip(result, layers):
        layer.uv.foreach_get("vector", flat)
        values[...] = flat.reshape(-1, 2).T
    return result


def generated(mesh):
    """Generated coordinates (3, V): where each vertex was in the texture space of the mesh before it was deformed."""
    location, size = (np.array(v, np.float64)[:, None] for v in (mesh.texspace_location, mesh.texspace_size))
    undeformed = _columns(mesh.vertices, "undeformed_co", np.float32)
    return np.divide(undeformed - location, 2 * size, out=np.zeros(undeformed.shape), where=size != 0) + 0.5


def is_flat(mesh):
    """Whether every face is shaded by its own geometric normal."""
    return mesh.normals_domain == "FACE" and not mesh.has_custom_normals


def material_indices(mesh):
    """(F,) indices of material slots, or (0,) where all are the first; Geometry Nodes can store negative ones, which count as 0."""
    if "material_index" not in mesh.attributes:
        return np.zeros(0, np.int32)
    indices = np.empty(len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("material_index", indices)
    return np.maximum(indices, 0) if indices.any() else np.zeros(0, np.int32)


def _columns(collection, attribute, dtype):
    """The three-component `attribute` of a collection as (3, N)."""
    flat = np.empty(3 * len(collection), dtype)
    collection.foreach_get(attribute, flat)
    return np.ascontiguousarray(flat.reshape(-1, 3).T)
