"""The one loop: a stack of batches, until it is empty."""

import numpy as np

from ..world.interaction import interact

_FEW_SHARE = 16
"""Fewer misses than one in so many stay in their batch."""


def trace(plan, rays, film, is_cancelled=lambda: False):
    """Follow `rays` and all that the integrator makes of them; light goes into `film`. Returns False if cancelled.

    The stack is depth first, so that an integrator that branches holds few batches at a time.
    """
    # Infinite densities and 0 / 0 of lanes that are dropped are meant; what reaches the film is checked there.
    with np.errstate(all="ignore"):
        return _trace(plan, rays, film, is_cancelled)


def _trace(plan, rays, film, is_cancelled):
    world = plan.world
    stack = [rays]
    while stack:
        if is_cancelled():
            return False
        rays = stack.pop()
        hits = plan.meet(plan, rays)
        for add_light in plan.on_rays:
            add_light(plan, rays, hits, film)
        if rays.depth > plan.settings.max_depth:
            continue
        rays, hits = _only_hits(rays, hits)
        if not hits.prim.size:
            continue
        surface = interact(world.triangles, plan.shading_normals, rays.d, hits)
        for p in plan.first_hits if rays.depth == 0 else ():
            film.first_hits[p.key][:, rays.slot] = p.values(plan, surface)
        if not world.materials.lobes:
            continue
        reflection = world.materials.at(surface.material)
        for add_light in plan.on_surface:
            add_light(plan, rays, surface, reflection, film)
        if rays.depth < plan.last_depth:
            stack.extend(plan.scatter(plan, rays, surface, reflection))
    return True


def _only_hits(rays, hits):
    """The rays that hit something, and their hits."""
    missed = np.nonzero(hits.prim < 0)[0]
    if not missed.size:
        return rays, hits
    if rays.depth and missed.size * _FEW_SHARE < hits.prim.size:
        # Packing costs more than carrying a few idle paths to the end of the bounce. Without throughput they add
        # nothing; their triangle, -1, is the last one. (Camera rays must be packed: passes record where they hit.)
        rays.beta[:, missed] = 0
        return rays, hits
    lanes = np.nonzero(hits.prim >= 0)[0]
    return rays.landed(lanes), hits.take(lanes)
