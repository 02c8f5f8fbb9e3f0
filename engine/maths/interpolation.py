"""What is between the texels of a picture that wraps around in u and ends in v.

Each way to interpolate has two sides that belong together: `*_texels` says which texels a place looks at and with which
weights, `*_place` takes uniform numbers to places around a texel whose density is just that weight. So texels that are
chosen in proportion to their values give places in proportion to the interpolated value.
"""

import numpy as np


def nearest_texels(u, v, shape):
    """One (row, column, weight) for places u, v (N,) in [0, 1] of a picture of `shape` (H, W): where they are."""
    height, width = shape
    row = np.minimum((v * height).astype(np.intp), height - 1)
    column = np.minimum((u * width).astype(np.intp), width - 1)
    return ((row, column, np.ones_like(u)),)


def nearest_place(row, column, u2, shape):
    """Places u, v (N,), uniform in the texels (row, column) (N,)."""
    height, width = shape
    return _scaled(column, u2[0], width), _scaled(row, u2[1], height)


def linear_texels(u, v, shape):
    """Four (row, column, weight), each (N,): the texels around places u, v (N,), by their bilinear weights."""
    height, width = shape
    left, dx = _split(u, width)
    above, dy = _split(v, height)
    right = np.where(left == width - 1, 0, left + 1)
    left = np.where(left < 0, width - 1, left)
    below = np.minimum(above + 1, height - 1)
    above = np.maximum(above, 0)
    return (
        (above, left, (1 - dy) * (1 - dx)),
        (above, right, (1 - dy) * dx),
        (below, left, dy * (1 - dx)),
        (below, right, dy * dx),
    )


def linear_place(row, column, u2, shape):
    """Places u, v (N,) with the density of a tent over the texels (row, column) (N,) and their neighbours."""
    height, width = shape
    u = _scaled(column, _tent(u2[0]) + 0.5, width)
    v = _scaled(row, _tent(u2[1]) + 0.5, height)
    # Reflected at the ends: the two halves of the tent add up to the flat weight that the last row has there.
    v = np.abs(v)
    return u - np.floor(u), np.minimum(v, 2 - v)


def _scaled(texel, offset, count):
    return (texel.astype(offset.dtype) + offset) / count


def _split(u, count):
    """The texel whose middle is before each place, from -1 on, and how far the place is towards the next one."""
    x = u * count
    x -= 0.5
    texel = np.floor(x)
    x -= texel
    return texel.astype(np.intp), x


def _tent(u1):
    """Offsets in [-1, 1) with density 1 - |x|."""
    return np.where(u1 < 0.5, np.sqrt(2 * u1) - 1, 1 - np.sqrt(np.maximum(2 - 2 * u1, 0)))
