"""The Blackman-Harris window as a pixel filter, as Cycles' default."""

from functools import lru_cache

import numpy as np

from . import registry

_STEPS = 2**14


@registry.add
class BlackmanHarris:
    """A smooth bell of the given width: soft edges without ringing; the default."""

    key = "blackman_harris"
    label = "Blackman-Harris"
    spans_pixels = True

    @staticmethod
    def offset(u2, width):
        """The inverse distribution, tabulated and linear between its entries; its second moment is right to 1e-4."""
        table = _inverse_cdf()
        place = u2 * _STEPS
        below = place.astype(np.int32)
        fraction = place - np.floor(place)
        return width * (table[below] + fraction * (table[below + 1] - table[below]))


def window(x):
    """The 4-term window over x in [-1/2, 1/2] (Harris 1978, "On the Use of Windows", p. 65); 1 at the middle."""
    phase = 2 * np.pi * (np.asarray(x, np.float64) + 0.5)
    return 0.35875 - 0.48829 * np.cos(phase) + 0.14128 * np.cos(2 * phase) - 0.01168 * np.cos(3 * phase)


@lru_cache(maxsize=1)
def _inverse_cdf():
    edges = np.linspace(-0.5, 0.5, 16 * _STEPS + 1)
    middles = 0.5 * (edges[:-1] + edges[1:])
    cdf = np.concatenate(([0.0], np.cumsum(window(middles))))
    table = np.interp(np.linspace(0, 1, _STEPS + 1), cdf / cdf[-1], edges).astype(np.float32)
    # A symmetric table keeps the image from moving by a fraction of a pixel.
    return 0.5 * (table - table[::-1])
