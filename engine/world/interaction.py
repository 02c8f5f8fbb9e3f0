"""Where rays meet the scene: points, normals, and where rays go on."""

from dataclasses import dataclass

import numpy as np

from ..constants import EPS32
from ..maths.vectors import face_towards, max_abs, normalize

START_ULPS = 8
"""How far rays start off their triangle, in units of EPS32 times coordinate plus extent (see `spawn`)."""


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """The surface points of M rays.

    p         (3, M) render space
    wo        (3, M) unit, towards the viewer
    n, ns     (3, M) geometric and shading normal, unit, both on the side of wo
    o         (3, M) where reflected rays start: p, lifted off the triangle along n
    prim      (M,) triangles
    material  (M,) rows of the materials
    """

    p: np.ndarray
    wo: np.ndarray
    n: np.ndarray
    ns: np.ndarray
    o: np.ndarray
    prim: np.ndarray
    material: np.ndarray


def flat_normals(triangles, prim, u, v, n):
    """Shading normals of a world where every mesh is flat: the geometric ones."""
    return n


def smooth_normals(triangles, prim, u, v, n):
    """Shading normals (3, M) interpolated between the corners and renormalised, turned to the side of n."""
    corners = triangles.corner_normals
    w = 1 - u - v
    ns = np.stack([w * corners[i][prim] + u * corners[i + 3][prim] + v * corners[i + 6][prim] for i in range(3)])
    return face_towards(normalize(ns), n)


def interact(triangles, shading_normals, d, hits):
    """The `Surface` where rays with directions d (3, M) met triangles; every one of `hits` is a hit.

    Reflected rays start START_ULPS * EPS32 * (max |p| + extent) above p: in proportion to the rounding of p and of
    the triangle, so it holds at every scale, and there is no fixed epsilon.
    """
    prim, u, v = hits.prim, hits.u, hits.v
    # From barycentric coordinates: the error stays that of the triangle, whatever the length of the ray.
    p = np.empty_like(d)
    for i in range(3):
        np.multiply(triangles.e1[i][prim], u, out=p[i])
        p[i] += triangles.e2[i][prim] * v
        p[i] += triangles.v0[i][prim]
    wo = -d
    n = face_towards(triangles.normal[:, prim], wo)
    offset = max_abs(p)
    offset += triangles.extent[prim]
    offset *= START_ULPS * EPS32
    return Surface(p, wo, n, shading_normals(triangles, prim, u, v, n), p + offset * n, prim, triangles.material[prim])
