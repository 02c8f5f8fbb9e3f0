"""Parameters of materials that textures fill in."""

from functools import partial

import numpy as np

from ..world.filling import filled_in
from ..world.texturing import TexturePoints
from .views import RayView


def points_of(plan, rays, surface):
    """The `TexturePoints` of a surface that `rays` met."""
    across = plan.footprints(plan, rays.carried, surface.prim, surface.wo)
    return TexturePoints(plan.world.attributes, surface.prim, surface.u, surface.v, RayView(plan, rays, surface.t), across)


def fill_in_textures(plan, rays, surface, reflection):
    """The reflection with the values of textures in the columns that they stand for; each only where its material is met."""
    return filled_in(plan.world.materials, reflection, surface.prim.size, _met(plan, rays, surface))


def _met(plan, rays, surface):
    """(row of the materials, lanes, `TexturePoints`) of each textured material that `rays` met."""
    points = None
    for row in plan.world.materials.textured:
        if row in surface.looked:
            yield row, *surface.looked[row]
            continue
        lanes = np.nonzero(surface.material == row)[0]
        if not lanes.size:
            continue
        points = points or points_of(plan, rays, surface)
        # Where one material is met everywhere there is nothing to pick; no relief has bent the normals of these lanes.
        yield (
            row,
            lanes,
            points.met(lambda: surface) if lanes.size == surface.prim.size else points.take(lanes).met(partial(surface.take, lanes)),
        )
