"""The Blackman-Harris window as a pixel filter, as Cycles' default."""

from functools import lru_cache

import numpy as np

from ..maths.tabulated import inverse_cdf, look_up
from . import registry


@registry.add
class BlackmanHarris:
    """A smooth bell of the given width: soft edges without ringing; the default."""

    key = "blackman_harris"
    label = "Blackman-Harris"
    spans_pixels = True

    @staticmethod
    def offset(u2, width):
        return width * look_up(_table(), u2)


def window(x):
    """The 4-term window over x in [-1/2, 1/2] (Harris 1978, "On the Use of Windows", p. 65); 1 at the middle."""
    phase = 2 * np.pi * (np.asarray(x, np.float64) + 0.5)
    return 0.35875 - 0.48829 * np.cos(phase) + 0.14128 * np.cos(2 * phase) - 0.01168 * np.cos(3 * phase)


@lru_cache(maxsize=1)
def _table():
    return inverse_cdf(window)
