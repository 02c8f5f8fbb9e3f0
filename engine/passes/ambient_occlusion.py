"""How open surfaces are to what is around them."""

import numpy as np

from ..dimensions import Dimension
from ..maths.frames import to_world
from ..maths.vectors import dot
from ..maths.warps import square_to_cosine_hemisphere
from ..wavefront.passing import opacity
from ..wavefront.recording import FirstHit
from . import registry


@registry.add
class AmbientOcclusion(FirstHit):
    """The share of a dull surface's surroundings that nothing hides within `World.occlusion_distance`, averaged; 0 where nothing is."""

    key = "Ambient Occlusion"
    label = "Ambient Occlusion"
    channels = "RGB"
    sends_shadow_rays = True
    covers = True

    @staticmethod
    def values(plan, rays, surface, reflection):
        wi = to_world(surface.ns, square_to_cosine_hemisphere(plan.numbers.two(rays, Dimension.OCCLUSION)))
        distance = np.full(surface.prim.size, plan.scene.world.occlusion_distance * plan.world.frame.scale, np.float32)
        shadow = plan.shadow_rays(plan, rays, surface, reflection, wi, distance)
        lanes, share = plan.unblocked(plan, *shadow, dot(surface.n, wi) > 0)
        result = np.zeros_like(wi)
        result[:, lanes] = share * opacity(plan, rays, surface).take(lanes)
        return result
