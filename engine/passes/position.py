"""Where things are."""

import numpy as np

from ..wavefront.recording import FirstHit
from . import registry


@registry.add
class Position(FirstHit):
    """Where the first sample meets something, in world space [m]; 0 where nothing is met."""

    key = "Position"
    label = "Position"
    channels = "XYZ"
    reduction = "first"

    @staticmethod
    def values(plan, rays, surface, reflection):
        # In double precision: what is far from the origin of the world is rounded once.
        return surface.p / np.float64(plan.world.frame.scale) + plan.world.frame.origin[:, None]
