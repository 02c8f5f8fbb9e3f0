"""Whitted's ray tracing (Whitted 1980): a tree of mirrored and refracted rays, and a shadow ray to the middle of every light.

    colour = direct light + k_r trace(mirrored) + k_t trace(refracted)

Nothing is left to chance: shadows are hard, and light that dull surfaces send each other is left out. The recursion ends
after `max_depth` bounces, or where a ray would count less than `min_contribution`, the lecture's epsilon_r.
"""

from ..wavefront.branching import mirrored_and_refracted
from ..wavefront.hard_light import add_hard_light, to_middles
from . import registry


@registry.add
class Whitted:
    """Mirrors, glass and hard shadows without any noise; no soft shadows, no light from surface to surface."""

    key = "whitted"
    label = "Whitted"
    is_complete = False
    samples_lights = True
    splits_white = True
    splits_specular = True
    tints_glass = True
    on_surface = (add_hard_light,)
    to_lights = staticmethod(to_middles)

    @staticmethod
    def scatter(plan, rays, surface, reflection):
        return mirrored_and_refracted(plan, rays, surface, reflection)
