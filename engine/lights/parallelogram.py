"""Two emissive triangles of a mesh that make a parallelogram: one light instead of two, and one stratum grid."""

import numpy as np

from ..maths import patches


class ParallelogramLight:
    """Made by the world from meshes that emit, never by users; columns as in `maths.patches`."""

    @staticmethod
    def sample(k, p, u2):
        """See `interfaces.Light.sample`."""
        return patches.sample(k, p, u2[0], u2[1])

    @staticmethod
    def middle(k):
        """See `interfaces.Light.middle`."""
        return np.full((2, 1), 0.5, np.float32)
