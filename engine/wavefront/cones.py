"""What a ray stands for: a cone around it, as wide as the part of the film that its sample has for itself.

Of N samples of a pixel each stands for one N-th of it, so cones are 1 / sqrt(N) as wide as a pixel: textures are averaged
over their footprints without aliasing at any number of samples, and what blurs them more than the pixel's filter does
vanishes as samples are added. Reflection and refraction leave the opening of a cone as it is.
(Amanatides 1984, "Ray tracing with cones"; Akenine-Moller et al. 2021, "Improved Shader and Texture Level of Detail Using Ray
Cones", JCGT 10(1).)
"""

import math

import numpy as np

from ..maths.vectors import cross, length
from ..world.texturing import footprints


def nothing_yet(plan, rays):
    """A column (N,) of zeros."""
    return np.zeros(rays.sample.shape, np.float32)


def as_the_film(plan, rays):
    """A column (N,) of True."""
    return np.ones(rays.sample.shape, bool)


CARRIED = (("width", nothing_yet), ("spread", nothing_yet), ("is_even", as_the_film))
"""The width of a cone where its ray starts, by how much it widens per distance, and whether its neighbours' lie beside it.

They do not after a scattering by chance: such rays meet surfaces here and there, and see them as finely as from above, as
what they pass at a slant is averaged by their being many. Rays that have landed also know their `extent`: the width there.
"""
WIDTHS = ("width", "spread")
"""Those of `CARRIED` that are in proportion to what a sample has of the film."""


def aim_cones(aim):
    """The stage `aim` of a plan, after which rays carry cones: as wide as the distance to the neighbouring pixels' rays."""

    def aimed(plan, rays, x, y):
        o, d = plan.camera.rays(plan.camera_k, x, y)
        right, below = plan.camera.rays(plan.camera_k, x + 1, y), plan.camera.rays(plan.camera_k, x, y + 1)
        share = np.float32(1 / math.sqrt(plan.settings.samples))
        # Twice the geometric mean would hold for the diagonal: the pixel's area is what the cone has to cover.
        rays.carried.width, rays.carried.spread = (
            share * np.sqrt(length(cross(across - middle, down - middle))) for middle, across, down in zip((o, d), right, below)
        )
        return aim(plan, rays, x, y)

    return aimed


def start_cones_in_range(plan, rays):
    """Camera rays have started where the clip range does, and have widened up to there."""
    k = plan.camera_k
    rays.carried.width = rays.carried.width + rays.carried.spread * (k.clip_start * plan.camera.ray_per_depth(k, rays.d))


def landing_with_cones(interact):
    """The stage `interact` of a plan, after which rays know how wide their cones are where they have landed."""

    def landed(plan, rays, hits):
        rays.carried.extent = rays.carried.width + rays.carried.spread * np.where(hits.prim >= 0, hits.t, 0)
        return interact(plan, rays, hits)

    return landed


def leave_with_cones(plan, rays, surface, reflection, scattered):
    """Scattered rays start with cones as wide as those that have landed."""
    scattered.carried.width = scattered.carried.extent
    scattered.carried.is_even = scattered.carried.is_even & np.isinf(scattered.pdf)
    del scattered.carried.extent


def edges_at_rest(plan, carried, prim):
    """The edges, two (3, N), of triangles `prim` (N,), render space; `carried` is what the rays carry that met them."""
    return plan.world.triangles.shape[3:9].take(prim, axis=1).reshape(2, 3, -1)


def edges_at_time(plan, carried, prim):
    """The same where triangles may move."""
    edges, movers = edges_at_rest(plan, carried, prim), plan.world.movers
    lanes = np.nonzero(prim >= movers.first)[0]
    if lanes.size:
        pose = movers.poses.at(movers.owner.take(prim.take(lanes) - movers.first), carried.time.take(lanes))
        for e in edges:
            e[:, lanes] = pose.vectors(e.take(lanes, axis=1))
    return edges


def footprints_of_cones(plan, carried, prim, wo, t=None):
    """What the cones of rays cut out of triangles `prim` (N,), see `world.texturing.footprints`; t (N,) is how far away, None: landed."""
    return footprints(*plan.edges(plan, carried, prim), wo, _width(carried, t), carried.is_even)


def _width(carried, t):
    return carried.extent if t is None else carried.width + carried.spread * t


def no_footprints(plan, carried, prim, wo, t=None):
    """Rays stand for nothing but themselves."""
    return
