"""Next-event estimation: a shadow ray from every surface point to a point on a light."""

import dataclasses

import numpy as np

from ..arrays import gather
from ..constants import EPS32
from ..dimensions import Dimension
from ..maths.vectors import dot, length
from .continuation import leaving
from .mis import power_heuristic

SHORTENED = np.float32(1 - 4 * EPS32)
"""Shadow rays end before the light, by more than the rounding of their length."""


def add_direct_light(plan, rays, surface, reflection, film):
    """Light that reaches the surface straight from one light, chosen and sampled; blocked by anything between."""
    index, probability, wi, distance, E, pdf = _one_light(plan, rays, surface)
    cos = reflection.cosine(surface, wi)
    f, scattered_pdf = reflection.eval(surface.ns, surface.wo, wi)
    L = rays.beta * f
    E *= cos * power_heuristic(pdf * probability, plan.world.lights.rival(index, scattered_pdf)) / probability
    L *= E
    arriving(plan, rays, surface, reflection, wi, distance, cos, L, index, film)


def to_no_light(plan, rays, surface):
    """`to_one_light` where there is none."""
    return ()


def to_one_light(plan, rays, surface):
    """Points on lights as one of them stands for all: its index, wi (3, N), distance (N,) and E (3, N) [W m^-2], for each.

    E, all together on average, is the irradiance of surfaces that face the lights, see `interfaces.Light.sample`.
    """
    index, probability, wi, distance, E, _ = _one_light(plan, rays, surface)
    yield index, wi, distance, E / probability


def _one_light(plan, rays, surface):
    """The index of a light and its probability, and what `interfaces.Light.sample` says of it."""
    lights = plan.world.lights
    # Seen from where the shadow ray starts, so that it ends where it should.
    index, probability, u2 = lights.choice.choose(surface.o, plan.numbers.two(rays, Dimension.LIGHT), plan.lit_side(surface))
    return index, probability, *lights.sample(index, surface.o, u2, rays.time)


def arriving(plan, rays, surface, reflection, wi, distance, cos, L, light, film):
    """Add L (3, N), reflected light from the directions wi (3, N), where nothing is in the way up to `distance` (N,).

    Only where cos (N,), that of `reflection.cosine`, is above 0. `light` is where it comes from, see `Film.add`.
    """
    L = plan.lit_lobes(plan, surface, reflection, wi, L, light)
    # Not "L > 0": what is not a number goes to the film, which counts it.
    candidate = ~(np.maximum(np.maximum(L[0], L[1]), L[2]) <= 0) & (cos > 0)
    lanes, share = plan.unblocked(plan, *plan.shadow_rays(plan, rays, surface, reflection, wi, distance), candidate)
    light = gather(light, lanes) if np.ndim(light) else light
    lit = plan.split_light(plan, rays, surface, reflection, wi)
    film.add(plan, lit, lanes, gather(L, lanes) * share, light, rays.depth + 1)


def shadow_rays_in_front(plan, rays, surface, reflection, wi, distance):
    """Shadow rays to what lies at `distance` (N,) along wi (3, N) from surface.o: rays, o, d (3, N), and limit (N,)."""
    return rays, surface.o, wi, distance * SHORTENED


def shadow_rays_on_either_side(plan, rays, surface, reflection, wi, distance):
    """The same, where light may come through the surface: what lies behind it is sought from behind, as scattered rays do."""
    shadow = dataclasses.replace(leaving(plan, rays, surface, reflection, wi, rays.beta, distance), depth=rays.depth)
    d, limit = wi, distance
    behind = np.nonzero((dot(surface.n, wi) < 0) & np.isfinite(distance))[0]
    if behind.size:
        # The same point, seen from the other side.
        way = (surface.o - shadow.o).take(behind, axis=1) + wi.take(behind, axis=1) * distance.take(behind)
        d, limit = wi.copy(), distance.copy()
        limit[behind] = length(way)
        d[:, behind] = way / limit.take(behind)
    return shadow, shadow.o, d, limit * SHORTENED


def unsplit(plan, rays, surface, reflection, wi):
    """The rays that have met `surface`, for light that it reflects from wi (3, N): nobody asks by which lobes."""
    return rays


def all_lobes(plan, surface, reflection, wi, L, light):
    """What is left of the light L (3, N) that `surface` reflects from lights: all of it, as none is hidden from any lobe."""
    return L


def any_side(surface):
    """The normals on the side that is to be lit: there is no such side, or nothing minds it."""
    return


def shaded_side(surface):
    """The normals (3, N) on the side that is to be lit."""
    return surface.ns


def no_side(plan, rays):
    """The first column `facing` of what camera rays carry."""
    return np.zeros_like(rays.d)


def remember_side(plan, rays, surface, reflection, scattered):
    """The stage that has scattered rays know which way the surface faces that they leave, for lights that they find."""
    scattered.carried.facing = surface.ns
