"""A uniform grid: the middles of cells, the same in every pixel, as the lecture's first remedy against aliasing.

Not random, and therefore wrong in a way that can be seen: what is finer than the grid aliases into patterns instead of
noise, and light that is left out at one pixel is left out at all of them. It is here to be looked at beside the others.
The cells have equal areas for any number of samples: rows of nearly as many cells each, and as high as they have cells.
In which order the cells are taken differs between dimensions, or a sample would choose its light by its place in the pixel.
"""

from functools import lru_cache

import numpy as np

from ..maths.hashing import mix_int, permute
from ..maths.strata import grid, place
from . import registry


@registry.add
class Grid:
    """The middles of a uniform grid, the same in every pixel: no noise, but aliasing; to study, not to work with."""

    key = "grid"
    label = "Uniform Grid"

    @staticmethod
    def one(key, sample, dimension, samples):
        return place(_cell(sample, dimension, samples), np.full(sample.shape, 0.5, np.float32), samples)

    @staticmethod
    def two(key, sample, dimension, samples):
        rows, width, y = _rows(samples)
        column = _cell(sample, dimension, samples)
        row = column // rows
        column -= row * rows
        # Dealt out to the rows one by one: the first rows get what is left over.
        row, column = column, row
        u2 = np.empty((2, sample.size), np.float32)
        u2[0] = column.view(np.int32)
        u2[0] += np.float32(0.5)
        u2[0] *= width.take(row)
        u2[1] = y.take(row)
        return u2


def _cell(sample, dimension, samples):
    return permute(sample, samples, np.full(sample.shape, mix_int(dimension)))


@lru_cache(maxsize=16)
def _rows(samples):
    """The number of rows; in each of them the width of a cell, and the middle in y."""
    rows = grid(samples)[1]
    cells = samples // rows + (np.arange(rows) < samples % rows)
    below = np.cumsum(cells) - cells
    return np.uint32(rows), (1 / cells).astype(np.float32), ((below + 0.5 * cells) / samples).astype(np.float32)
