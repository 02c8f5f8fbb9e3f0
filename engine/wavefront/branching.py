"""Rays that split: what integrators that follow a tree of rays share.

The tree is walked depth first. Every function is a generator of batches, so one batch for each depth is all that exists.
"""

import dataclasses

import numpy as np

from ..dimensions import Dimension
from ..maths.hashing import mix_int
from .continuation import leaving, thinned
from .direct import add_direct_light, to_one_light

_FEWER = 4
"""Each bounce has so many times fewer branches than the one before."""


def branches_at(plan, depth):
    """How many rays a hit after `depth` bounces splits into: `settings.branches`, fewer with every bounce, at least 1."""
    return max(1, plan.settings.branches // _FEWER**depth)


def mirrored_and_refracted(plan, rays, surface, reflection):
    """Every direction into which the specular lobes send light, a batch each.

    Which one a ray has taken is known to its random numbers (`stream`), or siblings would share theirs.
    """
    singular = dataclasses.replace(reflection, rough=())
    for i, (wi, weight) in enumerate(reflection.branches(surface)):
        beta = rays.beta * weight
        batch = leaving(plan, rays, surface, singular, wi, beta, np.full_like(wi[0], np.inf))
        yield _contributing(plan, dataclasses.replace(batch, stream=int(mix_int(rays.stream + i)) if i else rays.stream))


def _contributing(plan, batch):
    """The rays of a batch that count at least `min_contribution`; nothing counts 0."""
    brightest = np.maximum(np.maximum(batch.beta[0], batch.beta[1]), batch.beta[2])
    # A ray that splits off counts its share only: what is asked is what all its siblings count together.
    # What is no number goes on, to be counted and told of where it meets light.
    alive = ~((brightest <= 0) | (brightest * np.float32(batch.split) < plan.settings.min_contribution))
    return batch if alive.all() else batch.take(np.nonzero(alive)[0])


def split(rays, count, i):
    """Sibling i of `count` that share the work of `rays`: numbers of its own, and its share of the throughput."""
    if count == 1:
        return rays
    sample = rays.sample * np.uint32(count) + np.uint32(i)
    return dataclasses.replace(rays, beta=rays.beta / np.float32(count), sample=sample, split=rays.split * count)


def spread(plan, rays, surface, reflection, count):
    """`count` batches of directions, distributed as the rough lobes reflect; all together count as one."""
    for i in range(count):
        sibling = split(rays, count, i)
        u1 = plan.choose_lobe(plan, sibling)
        wi, weight, pdf = reflection.scatter(surface, u1, plan.numbers.two(sibling, Dimension.DIRECTION))
        scattered = leaving(plan, sibling, surface, reflection, wi, sibling.beta * weight, pdf)
        yield _contributing(plan, thinned(plan, sibling, scattered))


def add_distributed_light(plan, rays, surface, reflection, film):
    """As many shadow rays as directions follow, spread over the lights and their areas."""
    count = branches_at(plan, rays.depth)
    # Specular lobes have rays of their own, which take no share of those that look for the same light.
    rough = reflection.without_specular()
    for i in range(count):
        add_direct_light(plan, split(rays, count, i), surface, rough, film)


def to_spread_light(plan, rays, surface):
    """As `direct.to_one_light`, for as many points as `add_distributed_light` has."""
    count = branches_at(plan, rays.depth)
    for i in range(count):
        for light, wi, distance, E in to_one_light(plan, split(rays, count, i), surface):
            yield light, wi, distance, E / np.float32(count)
