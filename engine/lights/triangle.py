"""Emissive triangles of meshes, as a light that can be sampled."""

import numpy as np

from ..constants import EPS32
from ..maths.vectors import dot, max_abs
from ..maths.warps import square_to_triangle

END_ULPS = 8
"""How far sampled points are lifted off their triangle, in units of EPS32 times coordinate plus extent."""


class TriangleLight:
    """Both faces of a triangle shine; made by the world from objects whose material emits, never by users.

    Columns: v0, e1, e2, normal, radiance (3, M), area, extent (M,).
    """

    @staticmethod
    def sample(k, p, u2):
        """See `interfaces.Light.sample`; the point is lifted towards p, so that shadow rays end before the light."""
        u, v = square_to_triangle(u2)
        q = k.v0 + u * k.e1 + v * k.e2
        side = np.copysign(np.float32(END_ULPS * EPS32), dot(k.normal, p - q))
        q = q + k.normal * (side * (max_abs(q) + k.extent))
        to_light = q - p
        distance2 = dot(to_light, to_light)
        distance = np.sqrt(distance2)
        tiny = np.finfo(distance.dtype).tiny
        wi = to_light / np.maximum(distance, tiny)
        geometry = k.area * np.abs(dot(wi, k.normal)) / np.maximum(distance2, tiny)
        return wi, distance, k.radiance * geometry, triangle_pdf(geometry)


def triangle_pdf(geometry):
    """Density over solid angle [sr^-1] from area * |cos| / distance^2 (N,) of a uniformly sampled triangle."""
    with np.errstate(divide="ignore"):
        return 1 / geometry
