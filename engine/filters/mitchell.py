"""The filter of Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics", with B = C = 1/3.

Two cubics, over a full width that is 4 px in the paper: a hill out to 2/7 of the width and a lobe below 0 from there to its
edge, which makes edges steeper than any filter without lobes can. It is sampled by its absolute value: points where
hill meets hill or lobe meets lobe count positively, points where a hill meets a lobe negatively.
"""

from functools import lru_cache

import numpy as np

from ..maths.tabulated import inverse_cdf, look_up
from . import registry

_ZERO = 2 / 7
"""Where the filter crosses 0, in widths: 8/7 px of 4."""
_HILL = 355 / 343
"""The integral of the hill, out to the zeros, where that of the whole filter is 1."""
_LOBES = _HILL - 1
_POSITIVE = _HILL**2 + _LOBES**2


@registry.add
class Mitchell:
    """Sharper than a bell of its width through negative lobes, at the price of some ringing and noise; 4 px is its width."""

    key = "mitchell"
    label = "Mitchell-Netravali"
    spans_pixels = True
    negative_mass = 2 * _HILL * _LOBES

    @staticmethod
    def offset(u2, width):
        """Hill by hill, or else lobe by lobe; the first number chooses and is stretched again."""
        on_hill = np.float32(_HILL**2 / _POSITIVE)
        u, v = u2
        is_hill = u < on_hill
        u = _stretched(u, is_hill, on_hill)
        return width * np.stack((np.where(is_hill, _hill(u), _lobe(u)), np.where(is_hill, _hill(v), _lobe(v))))

    @staticmethod
    def negative_offset(u2, width):
        """Hill by lobe, or lobe by hill, as likely."""
        u, v = u2
        is_hill = u < np.float32(0.5)
        u = _stretched(u, is_hill, np.float32(0.5))
        return width * np.stack((np.where(is_hill, _hill(u), _lobe(u)), np.where(is_hill, _lobe(v), _hill(v))))


def mitchell(x):
    """The filter over x in [-1/2, 1/2] widths; its integral is 1/4, as over 4 px it is 1."""
    x = 4 * np.abs(x)
    near = (7 * x**3 - 12 * x**2 + 16 / 3) / 6
    far = (-7 / 3 * x**3 + 12 * x**2 - 20 * x + 32 / 3) / 6
    return np.where(x < 1, near, far)


def _stretched(u, is_below, edge):
    """u in [0, edge), or in [edge, 1), as a number in [0, 1) again."""
    stretched = np.where(is_below, u / edge, (u - edge) / (1 - edge))
    return np.minimum(stretched, np.float32(1 - 2**-24)).astype(u.dtype)


def _hill(u):
    return look_up(_tables()[0], u)


def _lobe(u):
    # From the middle outwards to either side.
    side = 2 * u - 1
    return np.copysign(look_up(_tables()[1], np.minimum(np.abs(side), np.float32(1 - 2**-24))), side)


@lru_cache(maxsize=1)
def _tables():
    return (
        inverse_cdf(lambda x: np.maximum(mitchell(x), 0), -_ZERO, _ZERO),
        inverse_cdf(lambda x: np.maximum(-mitchell(x), 0), _ZERO, 0.5),
    )
