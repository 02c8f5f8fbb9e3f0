"""Direct light with hard shadows: every light is one point, its middle, and gets a shadow ray of its own."""

import numpy as np

from ..dimensions import Dimension
from .direct import arriving

MOST_LIGHTS = 64
"""Up to so many lights are all asked at every hit; of more, one is chosen at random, and there is noise."""


def add_hard_light(plan, rays, surface, reflection, film):
    """Light from the middle of every light, reflected by the rough lobes."""
    for light, wi, distance, E in to_middles(plan, rays, surface):
        cos = reflection.cosine(surface, wi)
        f, _ = reflection.eval(surface.ns, surface.wo, wi)
        L = rays.beta * f
        L *= E * cos
        arriving(plan, rays, surface, reflection, wi, distance, cos, L, light, film)


def add_illumination(plan, rays, surface, reflection, film):
    """Light from the middle of every light by the lecture's illumination model, see `integrators.whitted_phong`."""
    ambient = plan.world.materials.ambient.take(surface.material, axis=1)
    every = np.arange(rays.slot.size)
    for light, wi, distance, E in to_middles(plan, rays, surface):
        I_L = E if plan.settings.light_falloff else E * _of_one_metre(distance, plan.world.frame.scale)
        lit = plan.split_light(plan, rays, surface, reflection, wi)
        L = plan.lit_lobes(plan, surface, reflection, wi, rays.beta * ambient * I_L, light)
        film.add(plan, lit, every, L, light, rays.depth + 1)
        L = rays.beta * reflection.illuminate(surface.ns, surface.wo, wi) * I_L
        arriving(plan, rays, surface, reflection, wi, distance, reflection.cosine(surface, wi), L, light, film)


def _of_one_metre(distance, scale):
    """What takes irradiance at `distance` (N,), render space, to that at one metre; lights infinitely far away have no falloff."""
    metres = distance / np.float32(scale)
    return np.where(np.isfinite(metres), metres * metres, 1)


def to_middles(plan, rays, surface):
    """As `direct.to_one_light`, for the middle of each light; the index is (N,) or a number."""
    lights = plan.world.lights
    if lights.count > MOST_LIGHTS:
        index, probability, u2 = lights.choice.choose(surface.o, plan.numbers.two(rays, Dimension.LIGHT), plan.lit_side(surface))
        wi, distance, E, _ = lights.sample_middle(index, surface.o, u2, rays.time)
        yield index, wi, distance, E / probability
        return
    u2 = np.empty((2, surface.o.shape[1]), np.float32) if lights.have_middles else plan.numbers.two(rays, Dimension.LIGHT)
    for index in range(lights.count):
        wi, distance, E, _ = lights.sample_middle(index, surface.o, u2, rays.time)
        yield index, wi, distance, E
