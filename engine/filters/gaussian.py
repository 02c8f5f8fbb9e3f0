"""A Gaussian, cut off: its standard deviation is a sixth of the width, and what is left at the edge is subtracted.

So it reaches 0 without a step, as in pbrt (Pharr, Jakob and Humphreys 2023, section 8.8.3), whose default, a radius of 1.5 px and
a standard deviation of 0.5 px, is a width of 3 px here.
"""

from functools import lru_cache

import numpy as np

from ..maths.tabulated import inverse_cdf, look_up
from . import registry


@registry.add
class Gaussian:
    """A bell of a sixth of the width in standard deviation; 3 px is a usual width: very soft, no ringing."""

    key = "gaussian"
    label = "Gaussian"
    spans_pixels = True

    @staticmethod
    def offset(u2, width):
        return width * look_up(_table(), u2)


@lru_cache(maxsize=1)
def _table():
    return inverse_cdf(lambda x: np.exp(-18 * x * x) - np.exp(-4.5))
