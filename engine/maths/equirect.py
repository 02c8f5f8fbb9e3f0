"""The sphere as a square: longitude and latitude, as Blender's equirectangular pictures have them.

u = 1/2 - atan2(y, x) / (2 pi): +x is in the middle, +y one quarter to the left of it; v = theta / pi, from +z down.
"""

import numpy as np


def direction_to_square(d):
    """(u, v), each (N,) in [0, 1], of unit directions (3, N)."""
    u = np.arctan2(d[1], d[0])
    u *= -0.5 / np.pi
    u += 0.5
    # Exact near the poles, where acos is not.
    v = np.arctan2(np.hypot(d[0], d[1]), d[2])
    v /= np.pi
    return u, v


def square_to_direction(u, v):
    """Unit directions (3, N): the inverse of `direction_to_square`."""
    phi = (0.5 - u) * (2 * np.pi)
    sin = _sin(v)
    return np.stack(np.broadcast_arrays(sin * np.cos(phi), sin * np.sin(phi), np.cos(np.pi * v)))


def square_to_direction_pdf(v):
    """Density [sr^-1] of directions whose u, v are uniform: 1 / (2 pi^2 sin(pi v)); at the poles very large."""
    return (0.5 / np.pi**2) / np.maximum(_sin(v), np.finfo(v.dtype).tiny)


def _sin(v):
    """sin(pi v), from the nearer pole: near v = 1 the digits of pi v are lost."""
    return np.sin(np.pi * np.minimum(v, 1 - v))
