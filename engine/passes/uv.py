"""Where on their textures things are."""

import numpy as np

from ..wavefront.recording import FirstHit
from . import registry

_UV = ("uv", "")


@registry.add
class Uv(FirstHit):
    """The texture coordinates of the first layer, and 1 where a mesh has any, averaged; 0 where nothing is met."""

    key = "UV"
    label = "UV"
    channels = "UVA"
    attributes = (_UV,)

    @staticmethod
    def values(plan, rays, surface, reflection):
        found = plan.world.attributes[_UV]
        uv, _, _ = found.at(surface.prim, surface.u, surface.v)
        return np.stack((uv[0], uv[1], found.is_there(surface.prim)))
