"""Turning local directions about +z into directions about a normal."""

import numpy as np


def to_world(n, local):
    """local (3, N), given about +z, turned about unit n (3, N): the rotation by pi about the bisector h of z and n.

    R = h h^T / (1 + |n_z|) - 1 with h = n + sign(n_z) z is orthogonal, maps z to n, and divides by nothing small. What lies along
    z becomes n to the bit, as close to a surface as that may be. The azimuth is arbitrary (but for n = z), as for every frame
    without a tangent.
    """
    # Plus 0 makes -0 a 0, or the frame of a vertical surface would hang on its winding.
    sign = np.copysign(1, n[2] + 0).astype(n.dtype, copy=False)
    x, y, z = local
    across = n[0] * x + n[1] * y
    result = n * z
    result[2] += sign * across
    across /= 1 + np.abs(n[2])
    result[0] += n[0] * across - x
    result[1] += n[1] * across - y
    return result
