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
    brightest = np.maximum(np.maximum(L[0], L[1]), L[2])
    lanes = np.nonzero((brightest > 0) & (cos > 0) & (dot(surface.n, wi) > 0))[0]
    limit = distance.take(lanes) * _SHORTENED
    blocked = world.accel.occluded(surface.o.take(lanes, axis=1), wi.take(lanes, axis=1), limit)
    lanes = lanes.take(np.nonzero(~blocked)[0])
    film.add(rays.slot.take(lanes), L.take(lanes, axis=1))


def only_light(plan, rays):
    """There is one light: no choice, and no random number."""
    return None, 1.0


def one_of_the_lights(plan, rays):
    """A light for each ray, in proportion to its power: indices and probabilities (N,)."""
    return plan.world.lights.choose(plan.numbers.one(rays, Dimension.LIGHT_CHOICE))
