"""Parameters of materials that textures fill in."""

import dataclasses

import numpy as np

from ..arrays import Columns
from ..constants import LUMINANCE
from ..world.materials import Lobe
from ..world.texturing import TexturePoints


def points_of(plan, rays, surface):
    """The `TexturePoints` of a surface that `rays` met."""
    across = plan.footprints(plan, rays.carried, surface.prim, surface.wo)
    return TexturePoints(plan.world.attributes, surface.prim, surface.u, surface.v, across)


def fill_in_textures(plan, rays, surface, reflection):
    """The reflection with the values of textures in the columns that they stand for; each only where its material is met."""
    materials = plan.world.materials
    points = points_of(plan, rays, surface)
    lobes = [*reflection.rough, *reflection.specular]
    own = {}
    for row, textured in materials.textured.items():
        lanes = np.nonzero(surface.material == row)[0]
        if not lanes.size:
            continue
        at = points.take(lanes)
        for t in textured:
            if t.lobe not in own:
                own[t.lobe] = _with_own_columns(lobes[t.lobe].k, surface.prim.size)
            value = np.maximum(at.value(t.texture), 0)
            if t.is_number:
                value = sum(np.float32(share) * channel for share, channel in zip(LUMINANCE, value))
            getattr(own[t.lobe], t.column)[..., lanes] = value
    for i, k in own.items():
        lobes[i] = Lobe(lobes[i].bsdf, k)
    rough = len(reflection.rough)
    return dataclasses.replace(reflection, rough=tuple(lobes[:rough]), specular=tuple(lobes[rough:]))


def _with_own_columns(k, n):
    """A copy of the table `k`, whose one row may stand for all, with a row for each of n lanes."""
    return Columns(**{name: np.array(np.broadcast_to(column, (*column.shape[:-1], n))) for name, column in vars(k).items()})
