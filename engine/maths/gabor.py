"""Sparse Gabor convolution noise (Lagae et al. 2009), with the very numbers of Blender's Gabor Texture.

Eight impulses for each cell with weights -1 or 1 (Tavernier et al. 2019, "Making Gabor Noise Fast and Normalized"); the sum
is a phasor, whose sine is the noise (Tricard et al. 2019, "Procedural Phasor Noise", section 3.1).
"""

import math
from itertools import product

import numpy as np

from .cellhash import unit

_IMPULSES = 8
_PI = np.float32(math.pi)
SPREADS = {2: 6 * math.sqrt(_IMPULSES * 0.5 * 0.25), 3: 6 * math.sqrt(_IMPULSES * 0.5 / (4 * math.sqrt(2)))}
"""Blender's range of the noise in two and three dimensions: six times what Lagae et al., equation 9, give for high frequencies
and weights of variance 1/2."""


def phasor(p, frequency, isotropy, orientation):
    """The cosine and sine parts (2, N) of the noise at p (2, N) or (3, N).

    frequency    waves for each unit, float32 (1,) or (N,)
    isotropy     from 0, all waves along `orientation`, to 1, along any direction
    orientation  an angle (1,) or (N,) in two dimensions; a unit vector (3, 1) or (3, N) in three
    """
    cell = np.floor(p)
    local = p - cell
    result = np.zeros((2, p.shape[1]), np.float32)
    for step in product((-1, 0, 1), repeat=len(p)):
        step = np.array(step[::-1], np.float32)[:, None]
        for k in range(_IMPULSES):
            _add_impulse(result, cell + step, local - step, 3 * k, (frequency, isotropy, orientation))
    return result


def _add_impulse(result, cell, place, seed, parameters):
    centre = _centre(*cell, seed + 1)
    way = place - centre
    distance = _dot(way, way)
    # The window ends at the unit distance; most impulses are farther.
    lanes = np.nonzero(distance < 1)[0]
    cell, way, distance = cell.take(lanes, axis=1), way.take(lanes, axis=1), distance.take(lanes)
    frequency, isotropy, orientation = (x if x.shape[-1] == 1 else x.take(lanes, axis=-1) for x in parameters)
    waves = frequency * _direction(orientation, isotropy, cell, seed)
    angle = 2 * _PI * _dot(way, waves)
    # A Gaussian times a Hann window, as it is cut off.
    size = np.exp(-_PI * distance) * (np.float32(0.5) + np.float32(0.5) * np.cos(_PI * distance))
    size = np.where(unit(*cell, seed + 2) < np.float32(0.5), -size, size)
    result[:, lanes] += size * np.stack((np.cos(angle), np.sin(angle)))


def _dot(a, b):
    total = a[0] * b[0]
    for x, y in zip(a[1:], b[1:]):
        total = total + x * y
    return total


def _centre(*seeds):
    """The place (D, N) of an impulse in its cell, from the coordinates of the cell and the impulse's seed."""
    if len(seeds) == 3:
        x, y, s = seeds
        return np.stack((unit(x, y, s), unit(s, x, y)))
    x, y, z, s = seeds
    return np.stack((unit(x, y, z, s), unit(z, x, s, y), unit(s, z, y, x)))


def _direction(orientation, isotropy, cell, seed):
    """Where the waves of an impulse go to, (D, N) unit."""
    if len(cell) == 2:
        angle = orientation + (unit(*cell, seed) - np.float32(0.5)) * _PI * isotropy
        return np.stack((np.cos(angle), np.sin(angle)))
    x, y, z, s = (*cell, seed)
    inclination = np.arccos(orientation[2]) + unit(x, y, z, s) * _PI * isotropy
    across = np.sqrt(orientation[0] ** 2 + orientation[1] ** 2)
    azimuth = np.copysign(np.float32(1), orientation[1]) * np.arccos(orientation[0] / across) + unit(z, x, s, y) * _PI * isotropy
    turned = np.stack((np.sin(inclination) * np.cos(azimuth), np.sin(inclination) * np.sin(azimuth), np.cos(inclination)))
    # What does not turn stays as it is, along z too, where there is no azimuth.
    return np.where(isotropy == 0, orientation, turned)
