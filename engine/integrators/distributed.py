"""Distributed ray tracing (Cook, Porter and Carpenter 1984): where Whitted sends one ray, many share the work.

At every hit `branches` shadow rays are spread over the lights, and as many rays over the directions into which dull and
glossy lobes reflect; mirrors and glass send all of their single rays. Each bounce has a quarter of the branches of the
one before, so the tree stays finite; once there is one branch it is path tracing. Lens and shutter are spread over the
samples of the pixel. The branches of a pixel's samples are one set of stratified numbers.
"""

from ..wavefront.branching import add_distributed_light, branches_at, mirrored_and_refracted, spread, to_spread_light
from . import registry


@registry.add
class Distributed:
    """Soft shadows, gloss and light from all around by many rays at each hit: fewer samples per pixel, each dearer."""

    key = "distributed"
    label = "Distributed"
    is_complete = True
    samples_lights = True
    splits_white = False
    splits_specular = True
    tints_glass = False
    on_surface = (add_distributed_light,)
    to_lights = staticmethod(to_spread_light)

    @staticmethod
    def scatter(plan, rays, surface, reflection):
        if reflection.rough:
            yield from spread(plan, rays, surface, reflection.without_specular(), branches_at(plan, rays.depth))
        yield from mirrored_and_refracted(plan, rays, surface, reflection)
