"""Jittered sampling: one number in each of as many equal cells as there are samples.

In one dimension the cells are `samples` intervals. In two they are a grid of columns x rows >= samples, as square as
it gets (Kensler 2013, Pixar TM 13-01, section 3); where columns * rows > samples some cells stay empty. Which sample
takes which cell is a random permutation, its own for each pixel and dimension, so every single sample is uniform
and the mean is unbiased for any number of samples.
"""

import math

import numpy as np

from ..constants import ONE_MINUS_EPS32
from ..maths.hashing import mix, mix_int, permute, to_unit
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
        h = mix(key ^ mix_int(2 * dimension))
        return _place(permute(sample, samples, h), to_unit(mix(h ^ sample)), samples)

    @staticmethod
    def two(key, sample, dimension, samples):
        h = mix(key ^ mix_int(2 * dimension))
        columns, rows = grid(samples)
        cell = permute(sample, columns * rows, h)
        row = cell // np.uint32(columns)
        column = cell - row * np.uint32(columns)
        jitter = mix(h ^ sample)
        return np.stack(
            (
                _place(column, to_unit(jitter), columns),
                _place(row, to_unit(mix(jitter ^ mix_int(2 * dimension + 1))), rows),
            )
        )


def _place(cell, jitter, cells):
    jitter += cell
    jitter *= np.float32(1 / cells)
    # Rounding may reach 1, which no warp expects.
    return np.minimum(jitter, np.float32(ONE_MINUS_EPS32), out=jitter)
