"""Gradient noise in one to four dimensions (Perlin 2002, "Improving Noise"), with the very numbers of Blender's Noise Texture."""

from functools import lru_cache

import numpy as np

from .cellhash import jenkins, unit

_U = np.uint32
_SCALES = {1: np.float32(0.25), 2: np.float32(0.6616), 3: np.float32(0.982), 4: np.float32(0.8344)}
"""They bring the noise of so many dimensions into [-1, 1]."""
MEAN_SIZES = {1: 0.2309, 2: 0.2599, 3: 0.2161, 4: 0.1983}
"""The mean of |noise| in so many dimensions, measured at ten million points."""
_PERIOD = np.float32(1e5)
_FAR = np.float32(1e6)


@lru_cache(maxsize=32)
def offset(seed, dimensions=3):
    """(D, 1) float32 in [100, 200]: where Blender looks up the noise number `seed` of one point."""
    axis = (np.arange(dimensions, dtype=np.float32),) if dimensions > 1 else ()
    return (100 + 100 * unit(np.full(dimensions, seed, np.float32), *axis))[:, None]


def noise(p):
    """Noise in [-1, 1] at p (D, N), (N,) float32: 0 at whole numbers, smooth between them, repeated every 100,000."""
    p = p.astype(np.float32, copy=False)
    is_far = np.abs(p) >= _PERIOD
    if is_far.any():
        # Far out there are but whole numbers, where all noise is 0: Blender looks between them.
        p = np.where(is_far, np.fmod(p, _PERIOD), p) + np.float32(0.5) * (np.abs(p) >= _FAR)
    cell = np.floor(p)
    p = p - cell
    cell = cell.astype(np.int32).view(_U)
    # The corners of the cell along leading axes, the last coordinate first: each is at the low or the high side.
    corners = [_along(axis, np.stack((c, c + _U(1))), len(p)) for axis, c in enumerate(cell)]
    ways = [_along(axis, np.stack((x, x - 1)), len(p)) for axis, x in enumerate(p)]
    values = _products(jenkins(*corners), *ways)
    # Products, as what a power rounds may depend on the number of lanes.
    for t in p[::-1] * p[::-1] * p[::-1] * (p[::-1] * (p[::-1] * 6 - 15) + 10):
        values = values[0] + t * (values[1] - values[0])
    return _SCALES[len(p)] * values


def _along(axis, sides, dimensions):
    """What belongs to the low and the high side of a cell (2, N), to be broadcast to all its corners (2, ..., 2, N)."""
    return sides.reshape((1,) * (dimensions - 1 - axis) + (2,) + (1,) * axis + sides.shape[1:])


def _products(hashes, *ways):
    """The scalar products of the ways from the corners with the gradients that the hashes stand for."""
    if len(ways) == 1:
        kind = hashes & _U(15)
        return _signed(1 + (kind & _U(7)).astype(np.float32), kind, 8) * ways[0]
    kind = hashes & _U((7, 15, 31)[len(ways) - 2])
    x, y, *rest = ways
    if not rest:
        return _signed(np.where(kind < 4, x, y), kind, 1) + _signed(2 * np.where(kind < 4, y, x), kind, 2)
    if len(rest) == 1:
        second = np.where(kind < 4, y, np.where((kind == 12) | (kind == 14), x, rest[0]))
        return _signed(np.where(kind < 8, x, y), kind, 1) + _signed(second, kind, 2)
    z, w = rest
    parts = np.where(kind < 24, x, y), np.where(kind < 16, y, z), np.where(kind < 8, z, w)
    return _signed(parts[0], kind, 1) + _signed(parts[1], kind, 2) + _signed(parts[2], kind, 4)


def _signed(value, kind, bit):
    """`value`, negative where `kind` has the `bit`."""
    # The bit becomes the sign of the float: without branches, and exact.
    return (value.view(_U) ^ ((kind & _U(bit)) << _U(32 - bit.bit_length()))).view(np.float32)
