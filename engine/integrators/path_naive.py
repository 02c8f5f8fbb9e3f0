"""The rendering equation as it is written: directions are uniform over the hemisphere, whatever the material.

The lecture's first estimator, 2 pi / N sum f L cos; to see what importance sampling of the BSDF buys.
"""

import numpy as np

from ..dimensions import Dimension
from ..wavefront.continuation import go_on
from ..wavefront.direct import to_one_light
from . import registry


@registry.add
class NaivePath:
    """Uniform directions and no shadow rays: the same picture once more, with the most noise of all; for teaching."""

    key = "path_naive"
    label = "Naive Path Tracing"
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
        wi, weight, pdf = reflection.scatter(surface, u1, plan.numbers.two(rays, Dimension.DIRECTION), uniformly=True)
        # Which lobe sends light on matters where rays carry along what has scattered them.
        reflection = reflection.of_direction(surface, wi) if plan.on_leaving else reflection
        return go_on(plan, rays, surface, reflection, wi, weight, np.full_like(pdf, np.inf))
