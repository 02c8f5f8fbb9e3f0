"""Path tracing without next-event estimation: light is found only by running into it. To see what shadow rays buy."""

import numpy as np

from ..dimensions import Dimension
from ..wavefront.continuation import go_on
from ..wavefront.direct import to_one_light
from . import registry


@registry.add
class BlindPath:
    """Path tracing without shadow rays to lights: the same picture with far more noise, and lights without a size stay dark."""

    key = "path_blind"
    label = "Path Tracing without Light Sampling"
    is_complete = True
    samples_lights = False
    splits_white = False
    splits_specular = False
    tints_glass = False
    on_surface = ()
    to_lights = staticmethod(to_one_light)

    @staticmethod
    def scatter(plan, rays, surface, reflection):
        u1 = plan.choose_lobe(plan, rays)
        wi, weight, pdf = reflection.scatter(surface, u1, plan.numbers.two(rays, Dimension.DIRECTION))
        # What is found need not be shared with a shadow ray.
        return go_on(plan, rays, surface, reflection, wi, weight, np.full_like(pdf, np.inf))
