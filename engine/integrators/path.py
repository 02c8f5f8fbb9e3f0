"""Path tracing: one ray goes on from every surface point (Kajiya 1986)."""

import numpy as np

from ..maths.vectors import dot
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
        wi = reflection.sample(surface.ns, surface.wo, u1, plan.numbers.two(rays, Dimension.DIRECTION))
        f, pdf = reflection.eval(surface.ns, surface.wo, wi)
        cos = dot(surface.ns, wi)
        beta = rays.beta * f
        beta *= cos / pdf
        # Below the geometric surface there is nothing to reflect into; such paths end, and still count.
        alive, q = survive(plan, rays, beta, (cos > 0) & (dot(surface.n, wi) > 0) & (pdf > 0))
        beta /= q
        scattered = Rays(surface.o, wi, beta, pdf, rays.slot, rays.key, rays.sample, rays.depth + 1)
        return (scattered if alive.all() else scattered.take(np.nonzero(alive)[0]),)


def survive(plan, rays, beta, valid):
    """Which paths go on (N,), and the probability q (N,) with which they do.

    Russian roulette (Arvo and Kirk 1990): a path that survives counts 1 / q, so the mean stays what it was.
    """
    brightest = np.maximum(np.maximum(beta[0], beta[1]), beta[2])
    alive = valid & (brightest > 0)
    if rays.depth < ROULETTE_DEPTH:
        return alive, np.ones_like(brightest)
    q = np.sqrt(np.minimum(brightest, 1))
    alive &= plan.numbers.independent(rays, Dimension.ROULETTE) < q
    return alive, q
