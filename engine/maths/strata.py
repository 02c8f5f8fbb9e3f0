"""Cells that divide the unit interval and the unit square, and numbers placed in them."""

import math
from functools import lru_cache

import numpy as np

from ..constants import ONE_MINUS_EPS32
from .hashing import mix, permute, to_unit


@lru_cache(maxsize=256)
def grid(samples):
    """(columns, rows) of the two-dimensional cells: the most square grid of `samples` of them, at most twice as wide as high.

    Where there is none, the most square one with at least as many: cells that stay empty cost more than those that are not square.
    """
    square = math.isqrt(samples)
    rows = next((rows for rows in range(square, math.isqrt((samples - 1) // 2), -1) if samples % rows == 0), square)
    return -(-samples // rows), rows


def interval(sample, samples, h):
    """One number (N,) in each of `samples` intervals, which one a permutation by the key h (N,) says."""
    return place(permute(sample, samples, h), to_unit(mix(h ^ sample)), samples)


def cell(sample, columns, rows, h):
    """(column, row), (N,) uint32 each: the cell of `sample` (N,), a permutation by the key h (N,) says which."""
    column = permute(sample, columns * rows, h)
    row = column // np.uint32(columns)
    column -= row * np.uint32(columns)
    return column, row


def place(cell, jitter, cells):
    """Numbers (N,) float32 in [0, 1): `jitter` [0, 1) of the way through `cell` uint32 of as many as `cells`; overwrites jitter."""
    # Converted through int32, which cells fit into: uint32 and float32 would meet in float64.
    jitter += cell.view(np.int32).astype(np.float32)
    jitter *= np.float32(1 / cells)
    # Rounding may reach 1, which no warp expects.
    return np.minimum(jitter, np.float32(ONE_MINUS_EPS32), out=jitter)
