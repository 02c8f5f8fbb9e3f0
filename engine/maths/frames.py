"""Orthonormal frames about a direction."""

import numpy as np


def tangents(n):
    """Two unit vectors s, t (3, N) that make a right-handed frame (s, t, n) with unit n.

    Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1), listing 3: no branch, no singularity.
    """
    x, y, z = n
    sign = np.copysign(1, z).astype(n.dtype, copy=False)
    a = -1 / (sign + z)
    b = x * y * a
    return np.stack((1 + sign * x * x * a, sign * b, -sign * x)), np.stack((b, sign + y * y * a, -y))


def to_world(n, local):
    """local (3, N), given in the frame whose z axis is n, as world vectors."""
    s, t = tangents(n)
    s *= local[0]
    t *= local[1]
    s += t
    s += n * local[2]
    return s
