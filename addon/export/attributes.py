"""What Blender's meshes have besides their shape, as the engine's mesh attributes: only what materials ask for."""

import numpy as np

from ...engine import MeshAttribute
from .hashes import unit_of

POINTINESS = ".pointiness"
ISLAND = ".random per island"
"""Attributes that are worked out; Blender has no names of its own with these dots."""
DEFAULT_COLOUR = ""
"""The colour attribute that is meant where none is named."""

_COMPONENTS = {
    "FLOAT": ("value", 1),
    "INT": ("value", 1),
    "INT8": ("value", 1),
    "BOOLEAN": ("value", 1),
    "FLOAT2": ("vector", 2),
    "FLOAT_VECTOR": ("vector", 3),
    "FLOAT_COLOR": ("color", 4),
    "BYTE_COLOR": ("color", 4),
}
"""Data type -> (property, how many numbers); byte colours are read as they are in linear light."""

_DTYPES = {"INT": np.int32, "INT8": np.int32, "BOOLEAN": bool}


def mesh_attributes(mesh, loops, names, groups=()):
    """The `MeshAttribute`s called `names` of an evaluated mesh, without those that it lacks.

    `loops` (3, F) are the corners of its triangles, `groups` the names of its vertex groups, which Blender counts as attributes.
    """
    return tuple(found for name in sorted(names) if (found := _attribute(mesh, loops, name, groups)))


def _attribute(mesh, loops, name, groups):
    if name == POINTINESS:
        return MeshAttribute(name=name, values=pointiness(mesh)[None])
    if name == ISLAND:
        return MeshAttribute(name=name, values=_random_of_islands(mesh)[None])
    attribute = mesh.attributes.get(name or _default_colour(mesh))
    if attribute is None:
        return MeshAttribute(name=name, values=_weights(mesh, groups.index(name))[None]) if name in groups else None
    if attribute.data_type not in _COMPONENTS:
        return None
    prop, count = _COMPONENTS[attribute.data_type]
    values = np.empty(len(attribute.data) * count, _DTYPES.get(attribute.data_type, np.float32))
    attribute.data.foreach_get(prop, values)
    values = values.reshape(-1, count).T
    if attribute.domain == "EDGE":
        return MeshAttribute(name=name, values=_mean_of_edges(mesh, values))
    indices = loops if attribute.domain == "CORNER" else _faces(mesh) if attribute.domain == "FACE" else np.zeros((3, 0))
    return MeshAttribute(name=name, values=values, indices=indices)


def _default_colour(mesh):
    return mesh.color_attributes.default_color_name


def _faces(mesh):
    faces = np.empty(len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("polygon_index", faces)
    return np.repeat(faces[None], 3, axis=0)


def _weights(mesh, index):
    weights = np.zeros(len(mesh.vertices), np.float32)
    for vertex in mesh.vertices:
        for group in vertex.groups:
            if group.group == index:
                weights[vertex.index] = group.weight
    return weights


def _mean_of_edges(mesh, values):
    """Values (C, V) of vertices: the mean of those (C, E) of the edges that meet there."""
    ends = _edges(mesh).ravel()
    count = np.maximum(np.bincount(ends, minlength=len(mesh.vertices)), 1)
    return np.stack([np.bincount(ends, np.tile(v, 2), len(mesh.vertices)) for v in values]) / count


def _edges(mesh):
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", edges)
    return edges.reshape(-1, 2).T


def pointiness(mesh):
    """How convex (V,) a mesh is around its vertices, as Cycles has it: from 0, at the end of a needle, to 1; 1/2 is flat.

    The angle between the normal and the mean direction of the edges, averaged with those of the neighbours. Vertices at the
    same place are one.
    """
    p, normals = (np.empty(3 * len(mesh.vertices), np.float32) for _ in range(2))
    mesh.vertices.foreach_get("co", p)
    mesh.vertices.foreach_get("normal", normals)
    p, normals = p.reshape(-1, 3), normals.reshape(-1, 3)
    _, first, same = np.unique(p, axis=0, return_index=True, return_inverse=True)
    same = same.ravel()
    count = first.size
    normal = np.stack([np.bincount(same, normals[:, axis], count) for axis in range(3)], axis=1)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(np.float32).tiny)
    a, b = np.unique(np.sort(same[_edges(mesh)], axis=0), axis=1)
    along = p[first[b]].astype(np.float64) - p[first[a]]
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), np.finfo(np.float32).tiny)
    degree = np.bincount(a, minlength=count) + np.bincount(b, minlength=count)
    mean = np.stack([np.bincount(a, c, count) - np.bincount(b, c, count) for c in along.T], axis=1) / np.maximum(degree, 1)[:, None]
    raw = np.where(degree > 0, np.arccos(np.clip((normal * mean).sum(axis=1), -1, 1)) / np.pi, 0)
    blurred = (raw + np.bincount(a, raw[b], count) + np.bincount(b, raw[a], count)) / (degree + 1)
    return blurred[same].astype(np.float32)


def _random_of_islands(mesh):
    """A random number (V,) for each part of a mesh that hangs together: Cycles' hash of the vertex that stands for the part."""
    parents, ranks = list(range(len(mesh.vertices))), [0] * len(mesh.vertices)

    def root(i):
        while parents[i] != i:
            parents[i] = parents[parents[i]]
            i = parents[i]
        return i

    # Which vertex stands for a part depends on the order of the edges.
    for a, b in _edges(mesh).T.tolist():
        a, b = root(a), root(b)
        if a == b:
            continue
        if ranks[a] < ranks[b]:
            a, b = b, a
        parents[b] = a
        ranks[a] += ranks[a] == ranks[b]
    return unit_of(np.array([root(i) for i in range(len(parents))], np.uint32))
