"""What rays meet in a world that stands still and lets no light through: the plain choices of a plan."""

import numpy as np

from ..arrays import gather
from ..world.interaction import interact

_MOST_SHARE = 4


def closest(plan, carried, o, d, limit=None):
    """`Hits` of the nearest triangles along o, d (3, N), up to `limit` (N,); `carried` is what the rays carry."""
    return plan.world.accel.closest(o, d, limit)


def occluded(plan, carried, o, d, limit):
    """Whether any triangle lies within `limit` (N,) along o, d (3, N): (N,) bool."""
    return plan.world.accel.occluded(o, d, limit)


def all_the_way(plan, rays):
    """How far rays go: there is no limit."""
    return


def travel(plan, rays, film):
    """`Hits` where a batch of rays ends; light met along the way goes into the film."""
    hits = plan.closest(plan, rays.carried, rays.o, rays.d, plan.reach(plan, rays))
    for add_light in plan.on_rays:
        add_light(plan, rays, hits, film)
    return hits


def all_of_it(plan, rays, t):
    """The share of light that is left after the ways t (N,) of `rays` through nothing."""
    return 1


def seen_at_rest(plan, rays, p):
    """Points p (3, N) of render space as a camera at rest sees them: where they are."""
    return p


def interact_at_rest(plan, rays, hits):
    """The `Surface` where `rays` met triangles."""
    return interact(plan.world.triangles, plan.shading_normals, rays.d, hits)


def unblocked(plan, rays, o, d, limit, candidate):
    """Which shadow rays of the lanes `candidate` (N,) bool arrive: lanes (M,), and the share of light that does, 1 or (3, M).

    o, d (3, N) and limit (N,) are those of the shadow rays, one for each of `rays`.
    """
    return np.nonzero(candidate & ~blocked(plan, rays.carried, o, d, limit, candidate))[0], 1


def blocked(plan, carried, o, d, limit, candidate):
    """`plan.occluded` where `candidate` (N,); what it says elsewhere means nothing."""
    count = np.count_nonzero(candidate)
    if count * _MOST_SHARE > candidate.size * (_MOST_SHARE - 1):
        # Packing costs more than a few rays of no length.
        return plan.occluded(plan, carried, o, d, limit * candidate)
    lanes = np.nonzero(candidate)[0]
    blocked = np.zeros(candidate.size, bool)
    blocked[lanes] = plan.occluded(plan, carried.take(lanes), gather(o, lanes), gather(d, lanes), gather(limit, lanes))
    return blocked
