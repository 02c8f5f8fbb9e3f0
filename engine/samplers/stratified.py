"""Jittered sampling: one number in each of as many equal cells as there are samples.

In one dimension the cells are `samples` intervals. In two they are a grid of columns x rows >= samples, see `strata.grid` (after
Kensler 2013, Pixar TM 13-01, section 3); where columns * rows > samples some cells stay empty. Which sample
takes which cell is a random permutation, its own for each pixel and dimension, so every single sample is uniform
and the mean is unbiased for any number of samples.
"""

from ..maths.hashing import mix, mix_int, to_unit2
from ..maths.strata import cell, grid, interval, place
from . import registry


@registry.add
class Stratified:
    """One random point in each cell of a grid: even in every pixel and dimension, whatever the number."""

    key = "stratified"
    label = "Stratified"

    @staticmethod
    def one(key, sample, dimension, samples):
        return interval(sample, samples, mix(key ^ mix_int(dimension)))

    @staticmethod
    def two(key, sample, dimension, samples):
        h = mix(key ^ mix_int(dimension))
        columns, rows = grid(samples)
        column, row = cell(sample, columns, rows, h)
        u2 = to_unit2(mix(h ^ sample))
        place(column, u2[0], columns)
        place(row, u2[1], rows)
        return u2
