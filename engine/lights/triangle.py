"""An emissive triangle of a mesh."""

import numpy as np

from ..maths import patches
from ..maths.warps import square_to_triangle


class TriangleLight:
    """Made by the world from meshes that emit, never by users; columns as in `maths.patches`."""

    @staticmethod
    def sample(k, p, u2):
        """See `interfaces.Light.sample`."""
        return patches.sample(k, p, *square_to_triangle(u2))

    @staticmethod
    def middle(k):
        """See `interfaces.Light.middle`: what the warp maps to the barycentre."""
        return np.full((2, 1), 2 / 3, np.float32)
