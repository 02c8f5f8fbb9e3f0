"""Flat patches that shine from both sides, v0 + u e1 + v e2: triangles and parallelograms differ only in where u, v go.

Columns: v0, e1, e2, normal, radiance (3, M); area (M,); lift (M,), see `lift`.
"""

import numpy as np

from ..constants import EPS32
from .vectors import dot

END_ULPS = 8
"""How far sampled points are lifted off their patch, in units of EPS32 times its largest coordinate and extent."""


def sample(k, p, u, v):
    """Towards the point (u, v) of each patch, see `interfaces.Light.sample`; u, v are uniform on the patch.

    The point is lifted towards p, so that shadow rays end before the patch.
    """
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
    return to_light, distance, k.radiance * geometry, pdf(geometry)


def lift(v0, e1, e2):
    """The column `lift` (M,) of patches given by a corner and two edges (3, M)."""
    farthest = np.abs(np.stack((v0, v0 + e1, v0 + e2, v0 + e1 + e2))).max(axis=(0, 1))
    extent = np.abs(np.stack((e1, e2))).max(axis=(0, 1))
    return (END_ULPS * EPS32) * (farthest + extent)


def pdf(geometry):
    """Density over solid angle [sr^-1] of a uniformly sampled patch, from area * |cos| / distance^2 (N,)."""
    with np.errstate(divide="ignore"):
        return 1 / geometry
