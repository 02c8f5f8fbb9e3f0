"""Next-event estimation: a shadow ray from every surface point to a point on a light."""

import numpy as np

from ..constants import EPS32
from ..maths.vectors import dot
from .mis import power_heuristic
from .numbers import Dimension

_SHORTENED = np.float32(1 - 4 * EPS32)


def add_direct_light(plan, rays, surface, reflection, film):
    """Light that reaches the surface straight from one light, chosen and sampled; blocked by anything between."""
    world = plan.world
    index, probability = plan.choose_light(plan, rays)
    u2 = plan.numbers.two(rays, Dimension.LIGHT_POINT)
    # Seen from where the shadow ray starts, so that it ends where it should.
    wi, distance, E, pdf = world.lights.sample(index, surface.o, u2)
    cos = dot(surface.ns, wi)
    f, scattered_pdf = reflection.eval(surface.ns, surface.wo, wi)
    L = rays.beta * f
    L *= E * (cos * power_heuristic(pdf * probability, scattered_pdf) / probability)
    # Light from below the geometric surface would leak through it.
    lanes = np.nonzero((dot(surface.n, wi) > 0) & (cos > 0) & (L.max(axis=0) > 0))[0]
    blocked = world.accel.occluded(surface.o[:, lanes], wi[:, lanes], distance[lanes] * _SHORTENED)
    lanes = lanes[~blocked]
    film.add(rays.slot[lanes], L[:, lanes])


def only_light(plan, rays):
    """There is one light: no choice, and no random number."""
    return None, 1.0


def one_of_the_lights(plan, rays):
    """A light for each ray, in proportion to its power: indices and probabilities (N,)."""
    return plan.world.lights.choose(plan.numbers.one(rays, Dimension.LIGHT_CHOICE))
