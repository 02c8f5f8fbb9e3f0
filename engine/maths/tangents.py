"""Tangents of texture coordinates that vary smoothly over a mesh, as normal maps are baked with.

As MikkTSpace has them (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", section 3.3): at each corner the mean of the
tangents of all triangles that meet there with the same position, normal and texture coordinates, and the same handedness,
each made orthogonal to the normal and weighted by the angle of its triangle.
"""

import numpy as np

from .vectors import cross, dot, length

_TINY = np.finfo(np.float64).tiny


def corner_tangents(mesh, uvs):
    """Tangents (4, 3 F), unit, of all corners of a mesh with texture coordinates `uvs` (2, K), and which (3, F) each corner takes.

    The fourth component is 1 where bitangents are n x t, else -1: texture coordinates that are mirrored.
    """
    faces = mesh.triangles.shape[1]
    p = mesh.vertices.astype(np.float64).take(mesh.triangles, axis=1)
    uv = uvs.astype(np.float64).take(mesh.uv_indices, axis=1)
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    if mesh.is_smooth:
        n = mesh.normals.astype(np.float64).take(mesh.normal_indices, axis=1)
    else:
        n = np.repeat(flat_normals(mesh)[0][:, None], 3, axis=1)
    (u1, v1), (u2, v2) = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    determinant = u1 * v2 - u2 * v1
    side = np.where(determinant < 0, -1.0, 1.0)
    tangent = _unit(v2 * e1 - v1 * e2) * side
    along = tangent[:, None] - dot(n, tangent[:, None]) * n
    # Triangles whose coordinates span nothing have no say.
    weighed = _unit(along) * (_angles(p, n) * (determinant != 0))
    _, group = np.unique(_hashes(np.concatenate((p, n, uv, np.broadcast_to(side, (1, 3, faces)))).reshape(9, -1)), return_inverse=True)
    total = np.stack([np.bincount(group, component.ravel()) for component in weighed])
    own = np.concatenate((_unit(total).take(group, axis=1), np.tile(side, 3)[None]))
    return own, np.arange(3 * faces).reshape(3, faces)


def flat_normals(mesh):
    """Normals (3, F) of the triangles of a mesh, and which (3, F) of them each corner takes."""
    a, b, c = mesh.vertices.astype(np.float64).take(mesh.triangles, axis=1).transpose(1, 0, 2)
    return _unit(cross(b - a, c - a)), np.broadcast_to(np.arange(a.shape[1], dtype=np.int32), (3, a.shape[1]))


def _hashes(rows):
    """A hash (N,) of 64 bits of each column of `rows` (R, N), as float32: equal for equal ones, and for no others in practice."""
    # Plus 0, or -0 would be another number.
    bits = (rows.astype(np.float32) + np.float32(0)).view(np.uint32)
    result = np.zeros(bits.shape[1], np.uint64)
    for row in bits:
        # Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators", figure 16: the mixing of SplitMix64.
        result = (result + row) * np.uint64(0x9E3779B97F4A7C15)
        result = (result ^ (result >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        result = (result ^ (result >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        result ^= result >> np.uint64(31)
    return result


def _angles(p, n):
    """The angles (3, F) [rad] of triangles at their corners p (3, 3, F), seen along n."""
    after, before = np.roll(p, -1, axis=1) - p, np.roll(p, 1, axis=1) - p
    a, b = (_unit(edge - dot(n, edge) * n) for edge in (after, before))
    return np.arccos(np.clip(dot(a, b), -1, 1))


def _unit(a):
    return a / np.maximum(length(a), _TINY)
