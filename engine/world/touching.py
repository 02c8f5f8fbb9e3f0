"""Bodies that touch: of faces that coincide a ray meets only one, so they are moved apart before anything is traced.

Rays start START_ULPS off the boundary that they have passed, and would start beyond another one in the same place: they would
enter the water without ever leaving the glass. So the bodies that share space grow, the stronger the more, each a
few times as much as rays start off: where two touched they overlap, and the stronger is there.
"""

import numpy as np

from ..constants import EPS32
from ..maths.vectors import cross, length
from .interaction import START_ULPS

_STEP = 4
"""By how many starts off a face each body grows more than the next weaker one; corners, where it slants, less."""


def moved_apart(vertices, indices, owner, layer, away=None):
    """Vertices (3, V) float32 of bodies that have grown outwards along their area-weighted normals.

    indices (3, F) are the triangles, owner (F,) their objects, and layer (F,) by how many steps they are to grow; 0: not.
    away (O,) is how far from the middle of render space the local frame of each object may be, None: they have none.
    """
    faces = np.nonzero(layer)[0]
    if not faces.size:
        return vertices
    used, corner = np.unique(indices[:, faces], return_inverse=True)
    corner = corner.reshape(3, -1)
    of_vertex = np.empty(used.size, np.intp)
    of_vertex[corner] = faces
    p = vertices.take(used, axis=1).astype(np.float64)
    # Corners in one place move together, also where a mesh does not share them, or it would burst along its edges.
    point = np.unique(np.concatenate((p, [owner.take(of_vertex)])), axis=1, return_inverse=True)[1].reshape(-1)
    a, b, c = p.take(corner, axis=1).transpose(1, 0, 2)
    at, normal = point.take(corner).ravel(), np.tile(cross(b - a, c - a), 3)
    n = np.stack([np.bincount(at, weights) for weights in normal])
    n /= np.maximum(length(n), np.finfo(np.float64).tiny)
    extent = np.zeros(n.shape[1])
    np.maximum.at(extent, at, np.tile(np.maximum(np.abs(b - a), np.abs(c - a)).max(axis=0), 3))
    size = np.abs(p).max(axis=0) + extent.take(point) + (0 if away is None else away.take(owner.take(of_vertex)))
    height = _STEP * START_ULPS * EPS32 * layer.take(of_vertex) * size
    grown = vertices.copy()
    grown[:, used] = p + height * n.take(point, axis=1)
    return grown
