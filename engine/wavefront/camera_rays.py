"""The first rays of paths: through the film, filtered, and through the lens where there is one."""

import numpy as np

from ..dimensions import Dimension
from ..maths.warps import square_to_disk, square_to_polygon
from .numbers import seed_of
from .records import Rays
from .signed_filter import negative_samples, offsets


def camera_rays(plan, pixels, first, count):
    """`Rays` for samples first .. first + count - 1 of `pixels`, P `tiles.Pixels` or parts of some: slot = sample * P + pixel.

    A pixel is known by its place in the full frame, so that a border renders to the pixels of the whole picture.
    """
    settings, real = plan.settings, plan.settings.real
    px, py = pixels.px, pixels.py
    replicate, sample = plan.replicates.of(np.arange(first, first + count))
    seeds = [seed_of(settings.seed, r) for r in range(replicate[0], replicate[-1] + 1)]
    keys = np.stack([pixels.keys(plan.numbers, settings.width, seed) for seed in seeds])
    n = count * px.size
    rays = Rays(
        o=np.zeros((3, n), real),
        d=np.zeros((3, n), real),
        beta=np.ones((3, n), real),
        pdf=np.zeros(0, real),
        slot=np.arange(n),
        key=keys.take(replicate - replicate[0], axis=0).ravel(),
        sample=np.repeat(sample.astype(np.uint32), px.size),
        depth=0,
    )
    for name, start in plan.carry:
        setattr(rays.carried, name, start(plan, rays))
    negative = negative_samples(plan.filter, settings.replicate_sizes)[first : first + count]
    dx, dy = offsets(plan.filter, pixels.spread(plan.numbers.two(rays, Dimension.FILTER)), settings.filter_width, negative)
    # Measured from the middle of the frame, where half pixels are exact.
    x = np.tile((px + (0.5 - 0.5 * settings.width)).astype(real), count) + dx
    y = np.tile((py + (0.5 - 0.5 * settings.height)).astype(real), count) + dy
    rays.o[...], rays.d[...] = plan.aim(plan, rays, x, y)
    pixels.narrow(rays.carried)
    for stage in plan.on_camera_rays:
        stage(plan, rays)
    return rays


def through_the_pinhole(plan, rays, x, y):
    """Origins and directions (3, N) of rays through film positions x, y (N,) [px] from the middle of the frame; no random number."""
    return plan.camera.rays(plan.camera_k, x, y)


def through_the_lens(plan, rays, x, y):
    """The same from random points of the aperture."""
    k = plan.camera_k
    lens = plan.aperture(k, plan.numbers.two(rays, Dimension.LENS))
    lens[0] *= k.lens_width
    lens[1] *= k.lens_height
    return plan.camera.lens_rays(k, x, y, lens)


def start_at(place):
    """The stage (plan, rays) for a camera that is not in the middle of render space, but at `place` (3,)."""
    place = np.array(place, np.float32)[:, None]

    def start_at_camera(plan, rays):
        rays.o[...] += place

    return start_at_camera


def seen_from(place):
    """Points (plan, rays, p) of render space as a camera at `place` (3,) sees them: from there."""
    place = np.array(place, np.float32)[:, None]
    return lambda plan, rays, p: p - place


def round_aperture(k, u2):
    """Points (2, N), uniform on the unit disk."""
    return square_to_disk(u2)


def bladed_aperture(k, u2):
    """Points (2, N), uniform on the regular polygon with corners on the unit circle."""
    return square_to_polygon(u2, k.blades, k.rotation)
