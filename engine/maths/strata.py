"""Cells that divide the unit interval and the unit square, and numbers placed in them."""

import math

import numpy as np

from ..constants import ONE_MINUS_EPS32


def grid(samples):
    """(columns, rows) of the two-dimensional cells: the most square grid with at least `samples` of them."""
    rows = math.isqrt(samples)
    return -(-samples // rows), rows


def place(cell, jitter, cells):
    """Numbers (N,) float32 in [0, 1): `jitter` [0, 1) of the way through `cell` uint32 of as many as `cells`; overwrites jitter."""
    # Converted through int32, which cells fit into: uint32 and float32 would meet in float64.
    jitter += cell.view(np.int32).astype(np.float32)
    jitter *= np.float32(1 / cells)
    # Rounding may reach 1, which no warp expects.
    return np.minimum(jitter, np.float32(ONE_MINUS_EPS32), out=jitter)
