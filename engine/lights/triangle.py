"""Emissive triangles of meshes, as a light that can be sampled."""

import numpy as np

from ..constants import EPS32
from ..maths.vectors import dot
from ..maths.warps import square_to_triangle

END_ULPS = 8
"""How far sampled points are lifted off their triangle, in units of EPS32 times its largest coordinate and extent."""


class TriangleLight:
    """Both faces of a triangle shine; made by the world from objects whose material emits, never by users.

    Columns: v0, e1, e2, normal, radiance (3, M); area (M,); lift (M,), END_ULPS * EPS32 * (max |p| + extent).
    """

    @staticmethod
    def sample(k, p, u2):
        """See `interfaces.Light.sample`; the point is lifted towards p, so that shadow rays end before the light."""
        u, v = square_to_triangle(u2)
        to_light = u * k.e1
        to_light += v * k.e2
        to_light += k.v0
        to_light -= p
        to_light -= np.copysign(k.lift, dot(k.normal, to_light)) * k.normal
        distance2 = dot(to_light, to_light)
        distance = np.sqrt(distance2)
        tiny = np.finfo(distance.dtype).tiny
        to_light /= np.maximum(distance, tiny)
        geometry = k.area * np.abs(dot(to_light, k.normal))
        geometry /= np.maximum(distance2, tiny)
        return to_light, distance, k.radiance * geometry, triangle_pdf(geometry)


def lift(v0, e1, e2):
    """The column `lift` (M,) of triangles given by a corner and two edges (3, M)."""
    farthest = np.abs(np.stack((v0, v0 + e1, v0 + e2))).max(axis=(0, 1))
    extent = np.abs(np.stack((e1, e2))).max(axis=(0, 1))
    return (END_ULPS * EPS32) * (farthest + extent)


def triangle_pdf(geometry):
    """Density over solid angle [sr^-1] from area * |cos| / distance^2 (N,) of a uniformly sampled triangle."""
    with np.errstate(divide="ignore"):
        return 1 / geometry
