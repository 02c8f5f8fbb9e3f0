"""Vectors turned, lane by lane: (3, N) float32, angles [rad], counter-clockwise seen from the tip of the axis."""

import numpy as np

from .arithmetic import divided
from .vectors import cross, dot, length


def about(axis, angle, p):
    """p turned by `angle` (1, N) about `axis` (3, N) of any length (Rodrigues); p itself about no axis."""
    size = length(axis)
    k = divided(axis, size)
    cos, sin = np.cos(angle), np.sin(angle)
    return np.where(size != 0, p * cos + cross(*np.broadcast_arrays(k, p)) * sin + k * dot(k, p) * (1 - cos), p)


def turned(p, angles, is_inverted=False):
    """p turned about x, then y, then z by `angles` (3, N); or back again."""
    order = (2, 1, 0) if is_inverted else (0, 1, 2)
    rows = list(p)
    for axis in order:
        angle = -angles[axis] if is_inverted else angles[axis]
        cos, sin = np.cos(angle), np.sin(angle)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        rows[i], rows[j] = cos * rows[i] - sin * rows[j], sin * rows[i] + cos * rows[j]
    return np.stack(np.broadcast_arrays(*rows))
