"""From the unit square to where samples are wanted; each warp stands beside its density.

Every warp maps u2 (2, N) in [0, 1)^2, equal areas to equal shares, and keeps near numbers near, so that stratified
numbers stay stratified. Directions are about +z.
"""

import numpy as np

from ..constants import INV_PI
from .circle import on_circle

_TWO_PI = 2 * np.pi

CENTRE = np.zeros((2, 1), np.float32)
"""What disks, hemispheres and cones map to their centre."""


def square_to_disk(u2):
    """Uniform on the unit disk, (2, N): r = sqrt(u), phi = 2 pi v."""
    r = np.sqrt(u2[0])
    disk = np.empty_like(u2)
    for row, side in zip(disk, on_circle(u2[1])):
        np.multiply(r, side, out=row)
    return disk


def square_to_disk_pdf():
    """1 / pi per unit area of the unit disk."""
    return INV_PI


def square_to_cosine_hemisphere(u2):
    """Directions with density cos / pi (Malley's method: the disk, lifted)."""
    w = np.empty((3, *u2.shape[1:]), u2.dtype)
    w[:2] = square_to_disk(u2)
    np.sqrt(1 - u2[0], out=w[2])
    return w


def square_to_cosine_hemisphere_pdf(w):
    """cos / pi [sr^-1] above the horizon, else 0."""
    return np.maximum(w[2], 0) * INV_PI


def square_to_uniform_hemisphere(u2):
    """Directions with density 1 / (2 pi): cos theta = 1 - u."""
    return _about_axis(u2[0], u2[1])


def square_to_uniform_hemisphere_pdf(w):
    """1 / (2 pi) [sr^-1] above the horizon, else 0."""
    return np.where(w[2] >= 0, 0.5 * INV_PI, 0)


def square_to_cone(u2, one_minus_cos):
    """Uniform within a cone about +z whose half-angle has 1 - cos = `one_minus_cos` (N,) in (0, 2]."""
    return _about_axis(u2[0] * one_minus_cos, u2[1])


def square_to_cone_pdf(one_minus_cos):
    """1 / solid angle [sr^-1]; inf for a cone without an opening."""
    with np.errstate(divide="ignore"):
        return (0.5 * INV_PI) / one_minus_cos


def square_to_cosine_power(u2, exponent):
    """Directions with density (n + 1) / (2 pi) cos^n; cos = (1 - u)^(1 / (n + 1)).

    1 - cos = -expm1(log1p(-u) / (n + 1)) keeps its digits for n = 1e6, where float32 cannot hold the cosine.
    """
    return _about_axis(-np.expm1(np.log1p(-u2[0]) / (exponent + 1)), u2[1])


def square_to_cosine_power_pdf(w, exponent):
    """(n + 1) / (2 pi) cos^n [sr^-1] above the horizon, else 0."""
    return (exponent + 1) * (0.5 * INV_PI) * np.maximum(w[2], 0) ** exponent * (w[2] > 0)


def square_to_triangle(u2):
    """Barycentric coordinates (u, v), uniform over a triangle: Heitz 2019, "A Low-Distortion Map", eq. 4."""
    return u2 - 0.5 * np.minimum(u2[0], u2[1])


def square_to_polygon(u2, corners, rotation):
    """Uniform on the regular polygon with `corners` on the unit circle, (2, N); `rotation` [rad] is where one edge's middle is.

    The first number chooses one of the triangles about the centre, and what is left of it a place within.
    """
    t = u2[0] * corners
    # A number just below 1 may be rounded up to `corners`.
    triangle = np.minimum(np.floor(t), corners - 1)
    weights = square_to_triangle(np.stack((np.minimum(t - triangle, 1), u2[1])))
    half = np.pi / corners
    middle = rotation + 2 * half * triangle
    first, second = middle - half, middle + half
    return np.stack(
        (
            weights[0] * np.cos(first) + weights[1] * np.cos(second),
            weights[0] * np.sin(first) + weights[1] * np.sin(second),
        )
    ).astype(u2.dtype, copy=False)


def square_to_polygon_pdf(corners):
    """1 / area per unit area of the polygon: n / 2 sin(2 pi / n)."""
    return 2 / (corners * np.sin(_TWO_PI / corners))


def _about_axis(one_minus_cos, turns):
    # sin^2 = (1 - cos)(1 + cos): no cancellation near the axis.
    sin = np.sqrt(one_minus_cos * (2 - one_minus_cos))
    x, y = on_circle(turns)
    return np.stack(np.broadcast_arrays(sin * x, sin * y, 1 - one_minus_cos))
