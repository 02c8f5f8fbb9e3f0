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
        # Below the geometric surface there is nothing to reflect into; such paths end, and still count.
        valid = (cos > 0) & (dot(surface.n, wi) > 0) & (pdf > 0)
        beta = rays.beta * f
        beta *= cos / np.where(valid, pdf, 1)
        survival = survive(plan, rays, beta, valid)
        lanes = np.nonzero(survival)[0]
        return (
            Rays(
                o=surface.o[:, lanes],
                d=wi[:, lanes],
                beta=beta[:, lanes] / survival[lanes],
                pdf=pdf[lanes],
                slot=rays.slot[lanes],
                key=rays.key[lanes],
                sample=rays.sample[lanes],
                depth=rays.depth + 1,
            ),
        )


def survive(plan, rays, beta, valid):
    """The probability (N,) with which each path that survives has done so; 0 for those that end here.

    Russian roulette (Arvo and Kirk 1990): a path goes on with probability q and then counts 1 / q, so the mean stays.
    """
    brightest = beta.max(axis=0)
    alive = valid & (brightest > 0)
    if rays.depth < ROULETTE_DEPTH:
        return alive.astype(np.float32)
    q = np.sqrt(np.minimum(np.where(alive, brightest, 0), 1))
    return q * (plan.numbers.one(rays, Dimension.ROULETTE) < q)


def only_lobe(plan, rays):
    """There is one lobe: no choice, and no random number."""
    return None


def one_of_the_lobes(plan, rays):
    """The number u1 (N,) that chooses a lobe of each surface."""
    return plan.numbers.one(rays, Dimension.LOBE)
