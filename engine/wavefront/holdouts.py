"""Surfaces that the camera sees as clear and black, `Material.holdout`: nothing behind them is seen, and nothing of themselves."""

import numpy as np

from ..world.texturing import TexturePoints, clean
from .clear_film import STRAIGHT
from .views import RayView


def hold_out(plan, rays, hits, film):
    """The stage that leaves the film clear by what surfaces hold out of rays straight from the camera; where all is, the way ends."""
    table = plan.world.holdouts
    met = np.nonzero(getattr(rays.carried, STRAIGHT, not rays.depth) & (hits.prim >= 0))[0]
    material = plan.world.triangles.material.take(hits.prim.take(met))
    own = np.nonzero(table.holds.take(material))[0]
    if not own.size:
        return
    lanes, material = met.take(own), material.take(own)
    share = table.share.take(material, axis=1)
    for row, texture in table.textured.items():
        there = np.nonzero(material == row)[0]
        if there.size:
            share[:, there] = np.minimum(clean(_points(plan, rays, hits, lanes.take(there)).value(texture)), 1)
    film.clear[0, rays.slot.take(lanes)] += (rays.beta.take(lanes, axis=1) * share).mean(axis=0)
    ends = lanes[(share == 1).all(axis=0)]
    rays.beta[:, ends] = 0
    hits.prim[ends] = -1


def _points(plan, rays, hits, lanes):
    prim, t, d = hits.prim.take(lanes), hits.t.take(lanes), rays.d.take(lanes, axis=1)
    across = plan.footprints(plan, rays.carried.take(lanes), prim, -d, t)
    return TexturePoints(plan.world.attributes, prim, hits.u.take(lanes), hits.v.take(lanes), RayView(plan, rays, t, lanes), across)
