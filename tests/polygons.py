"""Irradiance from polygons in closed form: the oracle for area lights, which shares no code with them."""

import math

import numpy as np


def polygon_irradiance(corners, p, normal, radiance=1.0):
    """Lambert 1760: E = L / 2 sum of angle_i (n . axis_i) over the edges, clipped at the horizon of p; never negative.

    `corners` (K, 3) of a flat polygon in order; both of its sides shine.
    """
    p, normal = np.asarray(p, float), np.asarray(normal, float)
    above = _clip([np.asarray(c, float) - p for c in corners], normal)
    total = 0.0
    for a, b in zip(above, above[1:] + above[:1]):
        axis = np.cross(a, b)
        length = np.linalg.norm(axis)
        if length > 0:
            total += math.atan2(length, a @ b) * (axis @ normal) / length
    return radiance * 0.5 * abs(total)


def _clip(corners, normal):
    """The part of the polygon with normal . corner >= 0 (Sutherland and Hodgman 1974)."""
    result = []
    for a, b in zip(corners, corners[1:] + corners[:1]):
        da, db = a @ normal, b @ normal
        if da >= 0:
            result.append(a)
        if (da >= 0) != (db >= 0):
            result.append(a + (b - a) * (da / (da - db)))
    return result
