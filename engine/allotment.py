"""Which pixels get more samples: those that lower the error of the picture most.

Of a number of samples in all, the squared errors of all pixels add up to least where each has a share of them in proportion to
the standard deviation of its samples (Neyman 1934, "On the Two Different Aspects of the Representative Method", J. R. Stat. Soc.
97(4), optimum allocation). That is not known but told by the samples themselves, and a pixel that has met nothing rare yet must
not be given up for it: a bias towards what is dark (Kirk and Arvo 1991, "Unbiased Sampling Techniques for Image Synthesis",
SIGGRAPH). So nothing is decided before every pixel has some replicates, see `ending`, what the pixels around say counts as much as what
the pixel says of itself, and none gets more than twice as many as it has before its error is looked at again.
"""

import numpy as np

from .maths.hashing import mix, to_unit

REACH = 2
"""How far [px] around a pixel is looked."""


def allotted(squares, samples, mean, ends):
    """How many samples each pixel is to have, (H, W) int, all in all about `mean` a pixel; none has less than it has.

    squares  (H, W) the squared error of each pixel as it is counted in that of the picture
    samples  (H, W) int, how many each has
    ends     rising: numbers of samples after which the error is told, which are those that a pixel may come to have
    """
    # The standard deviation of a single one.
    scatter = np.sqrt(_around(squares * samples))
    most = np.minimum(2 * samples, ends[-1])
    goals = np.clip(scatter * _factor(scatter, samples, most, mean), samples, most)
    place = np.searchsorted(ends, goals)
    above = ends.take(place)
    below = np.maximum(ends.take(np.maximum(place - 1, 0)), samples)
    # Up in so many of equal pixels that their mean is the goal, which are chosen by where they are alone.
    number = to_unit(mix(np.arange(samples.size, dtype=np.uint32))).reshape(samples.shape)
    rounded = np.where(goals - below > number * (above - below), above, below)
    # Where there are few none may be chosen: then all that are to have more at all.
    return rounded if (rounded > samples).any() else np.where(goals > samples, above, samples)


def _factor(scatter, least, most, mean):
    """The number of samples per `scatter` with which pixels have `mean` on average, none less than `least` or more than `most`."""
    some = scatter > 0
    if not some.any():
        return 0.0
    low, high = (least[some] / scatter[some]).min(), (most[some] / scatter[some]).max()
    for _ in range(40):
        middle = np.sqrt(low * high)
        if np.clip(scatter * middle, least, most).mean() < mean:
            low = middle
        else:
            high = middle
    return high


def _around(values):
    """The mean (H, W) of values (H, W) over squares around each pixel, as far as there are pixels."""
    return _down(_down(values).T).T


def _down(values):
    """Means over up to 2 `REACH` + 1 rows."""
    rows = len(values)
    padded, known = np.pad(values, ((REACH, REACH), (0, 0))), np.pad(np.ones((rows, 1)), ((REACH, REACH), (0, 0)))
    # Not by differences of running sums, which lose what is small after what is large.
    total, count = (sum(part[shift : shift + rows] for shift in range(2 * REACH + 1)) for part in (padded, known))
    return total / count
