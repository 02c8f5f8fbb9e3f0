"""The one loop: a stack of what is still to come, until it is empty.

Paths end one by one, and a call costs as much for a hundred lanes as for a thousand: few that are left of a batch wait until they can
be followed together with those of other batches.
"""

import numpy as np

from .records import Rays

_FEW_SHARE = 16
"""Fewer misses than one in so many stay in their batch."""
FEW = 2**15
"""Scattered rays that had better wait for others of their depth; they are enough when there are twice as many."""


def trace(plan, batches, film, is_cancelled=lambda: False):
    """Follow `batches` of rays, any iterable, and all that the integrator makes of them; light goes into `film`. False if cancelled.

    The stack holds iterators of batches, one for each depth: an integrator that branches makes the next batch when
    the one before has been followed to its end, so its tree of rays never exists in memory as a whole.
    """
    # Infinite densities and 0 / 0 of lanes that are dropped are meant; what reaches the film is checked there.
    with np.errstate(all="ignore"):
        return _trace(plan, batches, film, is_cancelled)


def few_wait(waiting, rays):
    """`rays` if they are to be followed now; None if they are left in `waiting`, {depth: batches}. What waits may come along."""
    if rays.depth == 0 or rays.slot.size >= FEW:
        return rays
    together = waiting.setdefault(rays.depth, [])
    together.append(rays)
    if sum(batch.slot.size for batch in together) < 2 * FEW:
        return None
    return Rays.joined(waiting.pop(rays.depth))


def none_wait(waiting, rays):
    """The same where rays have siblings, whose light would be added in another order."""
    return rays


def _trace(plan, batches, film, is_cancelled):
    world = plan.world
    stack, waiting = [iter(batches)], {}
    while stack or waiting:
        if is_cancelled():
            return False
        if not stack:
            rays = Rays.joined(waiting.pop(min(waiting)))
        else:
            rays = next(stack[-1], None)
            if rays is None:
                stack.pop()
                continue
            rays = plan.wait(waiting, rays)
            if rays is None:
                continue
        hits = plan.travel(plan, rays, film)
        if rays.depth > plan.settings.max_depth:
            continue
        rays, hits = _only_hits(rays, hits)
        if not hits.prim.size:
            continue
        surface = plan.interact(plan, rays, hits)
        for adjust in plan.adjust_surface:
            surface = adjust(plan, rays, surface)
        reflection = plan.reflect(surface)
        for adjust in plan.adjust_reflection:
            reflection = adjust(plan, rays, surface, reflection)
        for p in plan.first_hits if rays.depth == 0 else ():
            film.meet(p, rays.slot, p.values(plan, rays, surface, reflection))
        if not world.materials.lobes:
            continue
        for add_light in plan.on_surface:
            add_light(plan, rays, surface, reflection, film)
        if rays.depth < plan.last_depth:
            stack.append(iter(plan.scatter(plan, rays, surface, reflection)))
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
