"""Next-event estimation: a shadow ray from every surface point to a point on a light."""

import numpy as np

from ..constants import EPS32
from ..maths.vectors import dot
from .mis import power_heuristic
from .numbers import Dimension

SHORTENED = np.float32(1 - 4 * EPS32)
"""Shadow rays end before the light, by more than the rounding of their length."""


def add_direct_light(plan, rays, surface, reflection, film):
    """Light that reaches the surface straight from one light, chosen and sampled; blocked by anything between."""
    world = plan.world
    # Seen from where the shadow ray starts, so that it ends where it should.
    index, probability, u2 = world.lights.choice.choose(surface.o, plan.numbers.two(rays, Dimension.LIGHT))
    wi, distance, E, pdf = world.lights.sample(index, surface.o, u2)
    cos = dot(surface.ns, wi)
    f, scattered_pdf = reflection.eval(surface.ns, surface.wo, wi)
    L = rays.beta * f
    E *= cos * power_heuristic(pdf * probability, scattered_pdf) / probability
    L *= E
    arriving(plan, rays, surface, wi, distance, L, film)


def arriving(plan, rays, surface, wi, distance, L, film):
    """Add L (3, N), reflected light from the directions wi (3, N), where nothing is in the way up to `distance` (N,)."""
    # Light from below the geometric surface would leak through it. (Not "> 0": what is not a number goes to the film,
    # which counts it.)
    candidate = ~(np.maximum(np.maximum(L[0], L[1]), L[2]) <= 0) & (dot(surface.ns, wi) > 0) & (dot(surface.n, wi) > 0)
    lanes, share = plan.unblocked(plan, rays, surface.o, wi, distance * SHORTENED, candidate)
    film.add(rays.slot.take(lanes), L.take(lanes, axis=1) * share)
