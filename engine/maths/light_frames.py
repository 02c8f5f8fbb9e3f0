"""The own frames of lights, for textures on them: tables have `light_from_world` (12, M), its rows of four."""

import numpy as np

from .facing import unit
from .vectors import dot


def to_light(k, a):
    """Vectors a (3, N) of the world in the frames of lights."""
    rows = k.light_from_world
    return np.stack([np.broadcast_to(dot(rows[4 * i : 4 * i + 3], a), a[0].shape) for i in range(3)])


def around(k, n):
    """uv (2, N) around a bulb: longitude and latitude of where n (3, N) points, about the light's z axis (as in Cycles)."""
    x, y, z = unit(to_light(k, n))
    turn = np.where((x != 0) | (y != 0), 0.5 - np.arctan2(x, y) * np.float32(0.5 / np.pi), 0)
    return np.stack((turn, 1 - np.arccos(np.clip(z, -1, 1)) * np.float32(1 / np.pi)))
