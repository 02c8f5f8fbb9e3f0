"""Do two engines draw the same picture? Welch's test for every tile, between replicates with seeds of their own.

A replicate's mean over a tile of 16 x 16 pixels is the mean of thousands of paths, and replicates are independent of each
other whatever the sampler. All tiles and channels of a picture share the level ALPHA between them (Bonferroni), so a
sound engine fails one picture in a million by chance.
"""

import warnings

import bpy
import numpy as np
from scipy import stats

from glanz.tests import helpers as h
from glanz.tests.parity import parity

TILE = 16
ROUNDING = 1e-5
"""Of a mean of single precision pixels."""


def replicates(engine, path, count, first_seed=1):
    """(count, height, width, 3): pictures of the open file by `engine`, each with a seed of its own."""
    scene = bpy.context.scene
    pictures = []
    for seed in range(first_seed, first_seed + count):
        scene.glanz.seed = scene.cycles.seed = seed
        pictures.append(parity.pixels(engine, path))
    return np.array(pictures)


def tiles(pictures):
    """Means of tiles: (replicates, tiles, 3)."""
    n, height, width, _ = pictures.shape
    means = pictures.reshape(n, height // TILE, TILE, width // TILE, TILE, 3).mean(axis=(2, 4))
    return means.reshape(n, -1, 3)


def p_value(ours, theirs):
    """The smallest p of all tiles and channels, times their number, at most 1."""
    a, b = tiles(ours), tiles(theirs)
    # Tiles of nothing but sky have no noise, and no variance to compare with: equal but for rounding, or not.
    still = np.maximum(np.ptp(a, axis=0), np.ptp(b, axis=0)) <= ROUNDING * b.mean(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"), warnings.catch_warnings(action="ignore", category=RuntimeWarning):
        p = stats.ttest_ind(a, b, axis=0, equal_var=False).pvalue
    p = np.where(still, np.isclose(a.mean(axis=0), b.mean(axis=0), rtol=ROUNDING), p)
    return min(1.0, float(p.min() * p.size))


def agree(ours, theirs):
    """Whether no tile differs at level h.ALPHA; NaN does not agree."""
    return p_value(ours, theirs) >= h.ALPHA


def block_differences(ours, theirs, noise=0.003):
    """Relative differences of tiles' means, all channels, that are known to within a standard error of `noise`; dark tiles left out.

    Where a caustic is found by few paths only, means of few replicates say nothing about one percent; `agree` judges them.
    """
    a, b = tiles(ours), tiles(theirs)
    error = np.sqrt(a.var(axis=0, ddof=1) / len(a) + b.var(axis=0, ddof=1) / len(b))
    mean = b.mean(axis=0)
    known = (mean > 0) & (error <= noise * mean)
    return np.abs(a.mean(axis=0)[known] / mean[known] - 1)


def smallest_difference(ours, theirs):
    """The relative difference of a tile's mean that would be noticed half of the time, in the median tile."""
    a, b = tiles(ours), tiles(theirs)
    error = np.sqrt(a.var(axis=0, ddof=1) / len(a) + b.var(axis=0, ddof=1) / len(b))
    freedom = len(a) + len(b) - 2
    with np.errstate(invalid="ignore"):
        relative = error / b.mean(axis=0)
    return float(np.nanmedian(relative) * stats.t.isf(h.ALPHA / 2 / error.size, freedom))
