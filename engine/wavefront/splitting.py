"""By which kinds of lobes light has left the first surface that the camera sees, for passes that tell them apart.

Every path carries `split`, (2, 3, N): the shares, channel by channel, of its throughput that diffuse and glossy lobes have
sent on; the rest has been transmitted. What several lobes send into the same direction is shared in proportion to their
values there, so the parts of a path add up to the whole of it.
"""

import dataclasses

import numpy as np

from ..arrays import Columns
from ..maths.vectors import dot
from .film import BACKGROUND

DIFFUSE, GLOSSY, TRANSMITTED = range(3)
KINDS = {"Diffuse": DIFFUSE, "Glossy": GLOSSY, "Transmission": TRANSMITTED}
"""By the names of passes."""


def split_light(plan, rays, surface, reflection, wi):
    """The rays that have met `surface`, for light that it reflects from wi (3, N): they know by which lobes."""
    return rays if rays.depth else _with(rays, shares(surface, reflection, wi))


def not_split(plan, rays):
    """The first column `split` of what camera rays carry."""
    return np.zeros((2, 3, rays.slot.size), rays.d.dtype)


def split_by_lobes(plan, rays, surface, reflection, scattered):
    """The stage that has scattered rays know by which lobes they have left the first surface."""
    if rays.depth:
        return
    split = shares(surface, reflection, scattered.d)
    # Mirrors and smooth boundaries share their directions with nothing.
    singular = np.nonzero(reflection.chosen_lobe(rays.slot.size, plan.choose_lobe(plan, rays)) >= len(reflection.rough))[0]
    split[DIFFUSE, :, singular] = 0
    split[GLOSSY, :, singular] = (dot(surface.n, scattered.d) > 0).take(singular)[:, None]
    scattered.carried.split = split


def part(rays, lanes, L, kind):
    """What lobes of a `kind` have sent of the light L (3, M) of the rays `lanes` (M,)."""
    split = rays.carried.split.take(lanes, axis=-1)
    return L * (1 - split.sum(axis=0) if kind == TRANSMITTED else split[kind])


def colour(reflection, surface, kind):
    """The share of light (3, N) that lobes of a `kind` send on from the points of `surface`, in all directions."""
    share = np.zeros_like(surface.wo) + sum(lobe.bsdf.albedo(lobe.k) for lobe in reflection.by_kind()[kind].rough)
    for lobe in () if kind == DIFFUSE else reflection.specular:
        for wi, weight in dataclasses.replace(reflection, specular=(lobe,)).branches(surface):
            is_behind = dot(surface.n, wi) < 0
            if kind == TRANSMITTED and hasattr(lobe.k, "ior"):
                # Radiance grows where light is bent together; the light does not.
                weight = weight * np.square(np.where(surface.is_front, lobe.k.ior, 1 / lobe.k.ior)) / lobe.k.etendue
            share += weight * (is_behind == (kind == TRANSMITTED))
    return share


def is_of_world(plan, light):
    """Whether `light`, see `Film.add`, is the world's."""
    lights = plan.world.lights
    if lights.environment:
        return np.equal(0 if light is None else light, lights.first_patch - 1)
    return np.equal(light, BACKGROUND)


def shares(surface, reflection, wi):
    """The shares (2, 3, N) of the light that `surface` reflects from wi (3, N) which diffuse and glossy lobes send on."""
    values = [np.broadcast_to(kind.value(surface.ns, surface.wo, wi), wi.shape) for kind in reflection.by_kind()]
    whole = sum(values)
    # Where nothing is reflected it does not matter; but ambient light, which is not, counts as diffuse.
    found = np.zeros((2, *wi.shape), wi.dtype)
    found[DIFFUSE] = 1
    for share, value in zip(found, values):
        np.divide(value, whole, out=share, where=whole != 0)
    return found


def _with(rays, split):
    return dataclasses.replace(rays, carried=Columns(**vars(rays.carried) | {"split": split}))
