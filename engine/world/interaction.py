"""Where rays meet the scene: points, normals, and where rays go on."""

from dataclasses import dataclass, field, fields

import numpy as np

from ..arrays import gather
from ..constants import EPS32
from ..maths.vectors import dot, length

START_ULPS = 8
"""How far rays start off their triangle, in units of EPS32 times coordinate plus extent (see `spawn`)."""


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """The surface points of M rays.

    p         (3, M) render space
    wo        (3, M) unit, towards the viewer
    n, ns     (3, M) geometric and shading normal, unit, both on the side of wo
    o         (3, M) where reflected rays start: p, lifted off the triangle along n
    is_front  (M,) bool: the viewer is on the front, by winding
    prim      (M,) triangles
    material  (M,) rows of the materials
    u, v      (M,) where in the triangle: barycentric coordinates of its second and third corner
    t         (M,) how far the rays have come
    looked    {row of the materials: (lanes, `TexturePoints`)} where reliefs have looked textures up already
    """

    p: np.ndarray
    wo: np.ndarray
    n: np.ndarray
    ns: np.ndarray
    o: np.ndarray
    is_front: np.ndarray
    prim: np.ndarray
    material: np.ndarray
    u: np.ndarray
    v: np.ndarray
    t: np.ndarray
    looked: dict = field(default_factory=dict)

    def take(self, lanes):
        """The points `lanes`."""
        return Surface(*(gather(getattr(self, f.name), lanes) for f in fields(self) if f.name != "looked"))


def flat_normals(triangles, prim, u, v, n, sign):
    """Shading normals of a world where every mesh is flat: the geometric ones."""
    return n


def smooth_normals(triangles, prim, u, v, n, sign):
    """Shading normals (3, M) interpolated between the corners, renormalised, and turned as the geometric ones are.

    Only for the lanes on smooth triangles; the others keep the geometric normal.
    """
    row = gather(triangles.smooth, prim)
    lanes = np.nonzero(row >= 0)[0]
    corners = gather(triangles.corner_normals, gather(row, lanes)).astype(n.dtype, copy=False)
    corner, along_e1, along_e2 = corners.reshape(3, 3, -1)
    along_e1 *= gather(u, lanes)
    along_e2 *= gather(v, lanes)
    corner += along_e1
    corner += along_e2
    corner *= gather(sign, lanes) / np.maximum(length(corner), np.finfo(np.float32).tiny)
    ns = n.copy()
    for all_lanes, smooth_lanes in zip(ns, corner):
        all_lanes[lanes] = smooth_lanes
    return ns


def interact(triangles, shading_normals, d, hits):
    """The `Surface` where rays with directions d (3, M) met triangles; every one of `hits` is a hit.

    Reflected rays start START_ULPS * EPS32 * (max |p| + extent) above p: in proportion to the rounding of p and of
    the triangle, so it holds at every scale, and there is no fixed epsilon.
    """
    prim, u, v = hits.prim, hits.u, hits.v
    # From barycentric coordinates: the error stays that of the triangle, whatever the length of the ray.
    p, e1, e2, n = gather(triangles.shape, prim).reshape(4, 3, -1)
    e1 *= u
    e2 *= v
    e1 += e2
    p += e1
    wo = -d
    sign = np.copysign(np.float32(1), dot(n, wo))
    n *= sign
    offset = np.abs(p).max(axis=0)
    offset += gather(triangles.extent, prim)
    offset *= np.float32(START_ULPS * EPS32)
    o = offset * n
    o += p
    ns = shading_normals(triangles, prim, u, v, n, sign)
    return Surface(p, wo, n, ns, o, sign > 0, prim, gather(triangles.material, prim), u, v, hits.t)


def leave_in_front(surface, wi):
    """Origins (3, M) of rays that go on along wi, where all stay on the viewer's side."""
    return surface.o


def leave_on_either_side(surface, wi):
    """Origins (3, M) of rays that go on along wi, lifted off the triangle to the side of wi."""
    return surface.p + np.copysign(np.float32(1), dot(surface.n, wi)) * (surface.o - surface.p)
