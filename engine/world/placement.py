"""Objects placed in the world: all instances of a mesh at once."""

from dataclasses import dataclass

import numpy as np

from ..maths.transforms import cofactors, flips_orientation
from ..maths.vectors import length


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """All objects that share one mesh, in world space and one after the other.

    vertices        (3, V) float64 [m]
    triangles       (3, F) int32, into these vertices; counter-clockwise also where an object is mirrored
    normals         (3, K) float32, world space, unit; (3, 0): flat, or not wanted
    normal_indices  (3, F) which of them each corner of each triangle takes; (3, 0) without
    material        (F,) intp, rows of the materials
    owner           (F,) int32, the object's place in the scene
    mesh            the mesh that they share
    mirrored        whether each object turns the winding of its triangles, bool
    """

    vertices: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray
    normal_indices: np.ndarray
    material: np.ndarray
    owner: np.ndarray
    mesh: object
    mirrored: np.ndarray


def place(numbered, row, smooth):
    """The `Part`s of `numbered` objects, pairs (place in the scene, object).

    `row` numbers the materials, None is black; `smooth` asks for normals.
    """
    same_mesh = {}
    for place_in_scene, o in numbered:
        if o.mesh.triangles.shape[1]:
            same_mesh.setdefault(id(o.mesh), []).append((place_in_scene, o))
    return [_place_instances(instances, row, smooth) for instances in same_mesh.values()]


def _place_instances(instances, row, smooth):
    mesh = instances[0][1].mesh
    faces, points = mesh.triangles.shape[1], mesh.vertices.shape[1]
    matrix = np.stack([o.world_from_object for _, o in instances])
    vertices = matrix[:, :3, :3] @ mesh.vertices.astype(np.float64) + matrix[:, :3, 3:]
    mirrored = flips_orientation(matrix)
    triangles = _corners(mesh.triangles, mirrored, points)
    rows = [_material_rows(o, row) for _, o in instances]
    normals, normal_indices = np.zeros((3, 0), np.float32), np.zeros((3, 0), np.int32)
    if smooth and mesh.is_smooth:
        normals = (cofactors(matrix) @ mesh.normals.astype(np.float64)).transpose(1, 0, 2)
        norm = length(normals)
        normals /= np.where(norm > 0, norm, 1)
        normals = normals.reshape(3, -1).astype(np.float32)
        normal_indices = _corners(mesh.normal_indices, mirrored, mesh.normals.shape[1]).reshape(3, -1)
    return Part(
        vertices=vertices.transpose(1, 0, 2).reshape(3, -1),
        triangles=triangles.reshape(3, -1),
        normals=normals,
        normal_indices=normal_indices,
        material=np.concatenate(rows),
        owner=np.repeat(np.array([place_in_scene for place_in_scene, _ in instances], np.int32), faces),
        mesh=mesh,
        mirrored=mirrored,
    )


def _corners(indices, mirrored, count):
    """Corner indices (3, F) into `count` things, for each instance (3, K, F); mirrored triangles are wound the other way round."""
    starts = np.arange(mirrored.size) * count
    # In half the memory, if they fit.
    starts = starts.astype(np.int32) if mirrored.size * count < 2**31 else starts
    each = indices[:, None] + starts[:, None]
    each[1:, mirrored] = each[:0:-1, mirrored]
    return each


def _material_rows(o, row):
    rows = np.array([row[m] for m in o.materials] or [row[None]], np.intp)
    if o.mesh.material_indices.size:
        return rows.take(o.mesh.material_indices, mode="clip")
    return np.full(o.mesh.triangles.shape[1], rows[0])
