"""Path tracing: one ray goes on from every surface point (Kajiya 1986)."""

import numpy as np

from ..wavefront.numbers import Dimension
from ..wavefront.records import Rays
from . import registry

ROULETTE_DEPTH = 1
"""Paths of more bounces than this survive with the square root of their throughput."""


@registry.add
class Path:
    """All light paths, one random direction on from each surface; noise falls with the samples, nothing is left out."""

    key = "path"
    label = "Path Tracing"

    @staticmethod
    def scatter(plan, rays, surface, reflection):
        u1 = plan.choose_lobe(plan, rays)
        wi, weight, pdf = reflection.scatter(surface, u1, plan.numbers.two(rays, Dimension.DIRECTION))
        beta = rays.beta * weight
        alive, q = survive(plan, rays, beta)
        beta /= q
        scattered = Rays(plan.leave(surface, wi), wi, beta, pdf, rays.slot, rays.key, rays.sample, rays.depth + 1)
        return (scattered if alive.all() else scattered.take(np.nonzero(alive)[0]),)


def survive(plan, rays, beta):
    """Which paths go on (N,), and the probability q (N,) with which they do.

    Russian roulette (Arvo and Kirk 1990): a path that survives counts 1 / q, so the mean stays what it was.
    """
    brightest = np.maximum(np.maximum(beta[0], beta[1]), beta[2])
    alive = brightest > 0
    if rays.depth < ROULETTE_DEPTH:
        return alive, np.ones_like(brightest)
    q = np.sqrt(np.minimum(brightest, 1))
    alive &= plan.numbers.independent(rays, Dimension.ROULETTE) < q
    return alive, q
