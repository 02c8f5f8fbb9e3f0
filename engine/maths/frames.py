"""Turning local directions about +z into directions about a normal."""

import numpy as np


def to_world(n, local):
    """local (3, N), given about +z, turned about unit n (3, N): the rotation by pi about the bisector h of z and n.

    R = h h^T / (1 + |n_z|) - 1 with h = n + sign(n_z) z is orthogonal, maps z to n, and divides by nothing small. The
    azimuth is arbitrary (but for n = z), as for every frame without a tangent.
    """
    # Plus 0 makes -0 a 0, or the frame of a vertical surface would hang on its winding.
    sign = np.copysign(1, n[2] + 0).astype(n.dtype, copy=False)
    h = np.empty(np.broadcast(n, local).shape, n.dtype)
    h[...] = n
    h[2] += sign
    x, y, z = local[0], local[1], local[2] * sign
    h *= (h[0] * x + h[1] * y + h[2] * z) / (1 + np.abs(n[2]))
    h[0] -= x
    h[1] -= y
    h[2] -= z
    return h
