"""From points to pictures: flat, around a sphere or a tube, and onto the sides of a box.

Each way takes points p (3, N) and the half-axes of their footprints, two (3, N), or None, to picture coordinates x, y (N,)
and half-axes there, two (2, N), or None.
"""

import numpy as np


def flat(p, axes):
    """By x and y."""
    return np.ascontiguousarray(p[0]), np.ascontiguousarray(p[1]), axes and tuple(axis[:2] for axis in axes)


def _around(project):
    def projected(p, axes):
        x, y = project(2 * p - 1)
        if axes is None:
            return x, y, None
        beside = (project(2 * (p + axis) - 1) for axis in axes)
        # Across the seam it is not all the way round.
        return x, y, tuple(np.stack((u - x - np.round(u - x), v - y)) for u, v in beside)

    return projected


def _sphere(p):
    length = np.sqrt((p * p).sum(axis=0))
    up = np.clip(np.divide(p[2], length, out=np.zeros_like(length), where=length > 0), -1, 1)
    return _turn(p), np.where(length > 0, 1 - np.arccos(up) * np.float32(1 / np.pi), 0)


def _tube(p):
    return _turn(p), np.where((p[0] != 0) | (p[1] != 0), 0.5 * (p[2] + 1), 0)


def _turn(p):
    """The way round the z axis, from 0 to 1."""
    turn = np.arctan2(p[0], p[1])
    return np.where((p[0] != 0) | (p[1] != 0), 0.5 * (1 - turn * np.float32(1 / np.pi)), 0)


PROJECTIONS = {"flat": flat, "sphere": _around(_sphere), "tube": _around(_tube)}
"""All but the box. Spheres and tubes are around the middle of the unit cube, along z."""


def sides_of_box(p, axes, normal, blend):
    """(weight (N,), x, y, axes) of the sides along x, y and z, which `normal` (3, N) faces more or less.

    Where it faces none more than `blend` allows, two or three are blended: sharper where `blend` is less.
    """
    a, b, c = p
    for axis, weight in enumerate(_weights_of_box(np.abs(normal), np.float32(blend))):
        u, v = ((b, c), (a, c), (b, a))[axis]
        turned = (normal[axis] < 0) if axis == 0 else (normal[axis] > 0)
        sign = np.where(turned, np.float32(-1), np.float32(1))
        i, j = ((1, 2), (0, 2), (1, 0))[axis]
        across = axes and tuple(np.stack((sign * along[i], along[j])) for along in axes)
        yield weight, np.where(turned, 1 - u, u), np.ascontiguousarray(v), across


def _weights_of_box(n, blend):
    """The weights (3, N) of three sides for the sizes n (3, N) of a normal's parts."""
    n = n / np.maximum(n.sum(axis=0), np.finfo(np.float32).tiny)
    limit = 0.5 * (1 + blend)
    x, y, z = n
    facing = [(a > limit * (a + b)) & (a > limit * (a + c)) for a, b, c in ((x, y, z), (y, x, z), (z, x, y))]
    if not blend:
        # What faces two sides alike is on the first.
        return np.float32((~(facing[1] | facing[2]), facing[1] & ~facing[0], facing[2]))
    # Blends of two sides, and of all three.
    pairs = np.zeros((3, *n.shape), np.float32)
    for pair, (first, second) in zip(pairs, ((0, 1), (1, 2), (0, 2))):
        both = np.maximum(n[first] + n[second], np.finfo(np.float32).tiny)
        pair[first] = np.clip((n[first] / both - 0.5 * (1 - blend)) / blend, 0, 1)
        pair[second] = 1 - pair[first]
    three = ((2 - limit) * n + (limit - 1)) / (2 * limit - 1)
    beside = [z < (1 - limit) * (x + y), x < (1 - limit) * (y + z), y < (1 - limit) * (x + z)]
    return np.select([*facing, *beside], [*np.eye(3, dtype=np.float32)[:, :, None], *pairs], three)
