"""How paths go on, or end: what integrators that follow one ray from each surface share."""

import numpy as np

from ..arrays import Columns
from ..dimensions import Dimension
from ..maths.vectors import dot
from .records import Rays

ROULETTE_DEPTH = 1
"""Roulette begins after so many bounces: it would thin out the first directions, which are spread evenly over a pixel."""

FAINT = 0.25
"""Paths of less throughput are thinned out to it, so that those which go on weigh about the same, and none weighs much more than others.
With half of it the errors would be smaller still, but not by as much as the longer paths would cost."""

SQUEEZE = "squeeze"
"""The column (N,) of the squared index of the medium that rays are in, over that of the camera's."""


def go_on(plan, rays, surface, reflection, wi, weight, pdf):
    """The batches (one) of `rays` that leave `surface`, by its `reflection`, along wi (3, N), with throughput times weight (3, N)."""
    return (thinned(plan, rays, leaving(plan, rays, surface, reflection, wi, rays.beta * weight, pdf)),)


def leaving(plan, rays, surface, reflection, wi, beta, pdf):
    """The rays that leave `surface`, by its `reflection`, along wi (3, N) with throughput beta (3, N), and carry on what `rays` carried."""
    carried = Columns(**vars(rays.carried))
    origins = plan.leave(surface, wi)
    scattered = Rays(origins, wi, beta, pdf, rays.slot, rays.key, rays.sample, rays.depth + 1, rays.split, rays.stream, carried)
    for stage in plan.on_leaving:
        stage(plan, rays, surface, reflection, scattered)
    return scattered


def thinned(plan, rays, scattered):
    """What Russian roulette leaves of the rays `scattered` (N,) that `rays` (N,) have become.

    They are judged by what they carry to a light in the medium that the camera is in: what passes smooth glass on the way in is scaled
    down by the squared index, and scaled up again on the way out (pbrt's etaScale; Pharr, Jakob, Humphreys 2023, section 13.2.2).
    """
    beta = scattered.beta
    alive, q = survive(plan, rays, beta * getattr(scattered.carried, SQUEEZE, np.float32(1)))
    beta /= q
    return scattered if alive.all() else scattered.take(np.nonzero(alive)[0])


def unsqueezed(plan, rays):
    """The first column `squeeze` of what camera rays carry."""
    return np.ones(rays.slot.size, rays.d.dtype)


def squeeze(plan, rays, surface, reflection, scattered):
    """The stage that has scattered rays know by how much light was scaled where they have passed smooth boundaries.

    Where a material has several such lobes the first stands for all: roulette may judge by whatever it likes.
    """
    lobe = next(lobe for lobe in reflection.specular if hasattr(lobe.k, "ior"))
    passed = np.nonzero(np.isinf(scattered.pdf) & (dot(surface.n, scattered.d) < 0))[0]
    eta2 = np.square(np.broadcast_to(lobe.k.ior, scattered.pdf.shape).take(passed))
    column = rays.carried.squeeze.copy()
    column[passed] *= np.where(surface.is_front.take(passed), eta2, 1 / eta2)
    scattered.carried.squeeze = column


def survive(plan, rays, beta):
    """Which paths of throughput beta (3, N) go on (N,), and the probability q (N,) with which they do.

    Russian roulette (Arvo and Kirk 1990): a path that survives counts 1 / q, so the mean stays what it was.
    """
    brightest = np.maximum(np.maximum(beta[0], beta[1]), beta[2])
    # Siblings share what one ray would have carried.
    brightest *= np.float32(rays.split)
    # What is no number goes on, to be counted and told of where it meets light.
    alive = ~(brightest <= 0)
    if rays.depth < ROULETTE_DEPTH:
        return alive, np.ones_like(brightest)
    q = np.minimum(brightest * np.float32(1 / FAINT), 1)
    alive &= ~(plan.numbers.independent(rays, Dimension.ROULETTE) >= q)
    return alive, q
