"""The tent, or triangle, filter: weight falls linearly from the pixel's centre to half of the width, where it is 0.

A tent of 2 px is the linear interpolation between pixels, transposed: each sample goes to its neighbours in proportion.
"""

import numpy as np

from . import registry


@registry.add
class Tent:
    """Falls linearly to its edge; 2 px is a good width: soft, little aliasing, no ringing."""

    key = "tent"
    label = "Tent"
    spans_pixels = True

    @staticmethod
    def offset(u2, width):
        """The inverse distribution; the half towards the edge from its own end, where it is steep and must be exact."""
        side = 2 * u2 - 1
        return np.copysign(0.5 * width * (1 - np.sqrt(1 - np.abs(side))), side)
