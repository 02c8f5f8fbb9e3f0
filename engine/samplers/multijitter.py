"""Correlated multi-jittered sampling: jittered, and stratified in each coordinate alone as well.

Each cell (column, row) of the grid is divided once more, into rows x columns parts. The sample sits in the part that two
permutations choose, one of the rows (the same in all columns) and one of the columns (the same in all rows), so that no
two samples share one of the columns * rows thin strips in x, nor in y (Kensler 2013, "Correlated Multi-Jittered Sampling",
Pixar TM 13-01, section 2). Where columns * rows > samples some cells and their strips stay empty. In one dimension
it is the same as jittering.

The error falls as N^-3/2 for light that is a sum f(x) + g(y) or fades out to the borders, and is below that of jittering at
edges by a constant. As the permutations are the same all over, it falls as N^-3/4 only where the difference between
opposite borders varies along them, as for exp(x + y): there jittering is better from about 200 samples on, and Sobol anyway.
"""

import numpy as np

from ..maths.hashing import mix, mix_int, permute, to_unit2
from ..maths.strata import cell, grid, interval, place
from . import registry


@registry.add
class Multijitter:
    """Stratified in both coordinates alone as well: less noise than stratified with few samples, and at edges."""

    key = "multijitter"
    label = "Multi-Jittered"

    @staticmethod
    def one(key, sample, dimension, samples):
        return interval(sample, samples, mix(key ^ mix_int(dimension)))

    @staticmethod
    def two(key, sample, dimension, samples):
        h = mix(key ^ mix_int(dimension))
        columns, rows = grid(samples)
        column, row = cell(sample, columns, rows, h)
        u2 = to_unit2(mix(h ^ sample))
        h = mix(h)
        x = permute(row, rows, h)
        y = permute(column, columns, mix(h))
        column *= np.uint32(rows)
        x += column
        row *= np.uint32(columns)
        y += row
        place(x, u2[0], columns * rows)
        place(y, u2[1], columns * rows)
        return u2
