"""Jittered sampling: one number in each of as many equal cells as there are samples.

In one dimension the cells are `samples` intervals. In two they are a grid of columns x rows >= samples, as square as
it gets (Kensler 2013, Pixar TM 13-01, section 3); where columns * rows > samples some cells stay empty. Which sample
takes which cell is a random permutation, its own for each pixel and dimension, so every single sample is uniform
and the mean is unbiased for any number of samples.
"""

import math

import numpy as np

from ..constants import ONE_MINUS_EPS32
from ..maths.hashing import mix, mix_int, permute, to_unit, to_unit2
from . import registry


def grid(samples):
    """(columns, rows) of the two-dimensional cells: the most square grid with at least `samples` of them."""
    rows = math.isqrt(samples)
    return -(-samples // rows), rows


@registry.add
class Stratified:
    """One sample in each cell of a grid, per pixel and dimension: least noise for smooth light; the default."""

    key = "stratified"
    label = "Stratified"

    @staticmethod
    def one(key, sample, dimension, samples):
        h = mix(key ^ mix_int(dimension))
        return _place(permute(sample, samples, h), to_unit(mix(h ^ sample)), samples)

    @staticmethod
    def two(key, sample, dimension, samples):
        h = mix(key ^ mix_int(dimension))
        columns, rows = grid(samples)
        cell = permute(sample, columns * rows, h)
        row = cell // np.uint32(columns)
        cell -= row * np.uint32(columns)
        u2 = to_unit2(mix(h ^ sample))
        _place(cell, u2[0], columns)
        _place(row, u2[1], rows)
        return u2


def _place(cell, jitter, cells):
    # Converted through int32, which cells fit into: uint32 and float32 would meet in float64.
    jitter += cell.view(np.int32).astype(np.float32)
    jitter *= np.float32(1 / cells)
    # Rounding may reach 1, which no warp expects.
    return np.minimum(jitter, np.float32(ONE_MINUS_EPS32), out=jitter)
