"""Parameters of materials that textures fill in."""

from functools import partial

import numpy as np

from ..scene.textured import luminance
from ..world.materials import Lobe
from ..world.texturing import TexturePoints, clean
from .views import RayView

_SCALES = ("reflectance", "transmittance")
"""The parameters to which the albedo of a lobe is in proportion."""


def points_of(plan, rays, surface):
    """The `TexturePoints` of a surface that `rays` met."""
    across = plan.footprints(plan, rays.carried, surface.prim, surface.wo)
    return TexturePoints(plan.world.attributes, surface.prim, surface.u, surface.v, RayView(plan, rays, surface.t), across)


def fill_in_textures(plan, rays, surface, reflection):
    """The reflection with the values of textures in the columns that they stand for; each only where its material is met.

    There the lobes together reflect at most what does not pass straight on, and are chosen by what they reflect.
    """
    materials = plan.world.materials
    points, count = None, surface.prim.size
    lobes = [*reflection.rough, *reflection.specular]
    # Where there is but one lobe, the table has no shares by lane.
    own, shares = {}, np.array(np.broadcast_to(reflection.shares if len(lobes) > 1 else np.float32(1), (len(lobes), count)))
    for row, textured in materials.textured.items():
        if row in surface.looked:
            lanes, at = surface.looked[row]
        else:
            lanes = np.nonzero(surface.material == row)[0]
            if not lanes.size:
                continue
            points = points or points_of(plan, rays, surface)
            # Where one material is met everywhere there is nothing to pick; no relief has bent the normals of these lanes.
            at = points.met(lambda: surface) if lanes.size == count else points.take(lanes).met(partial(surface.take, lanes))
        for t in textured:
            if t.lobe not in own:
                own[t.lobe] = lobes[t.lobe].k.repeated(count)
            getattr(own[t.lobe], t.column)[..., lanes] = t.value(at)
        tables = [own.get(i, lobe.k).pick(lanes) for i, lobe in enumerate(lobes)]
        albedos = [lobe.bsdf.albedo(k) for lobe, k in zip(lobes, tables)]
        rest = 1 - sum(np.minimum(clean(at.value(passed)), 1) for passed in materials.straight[row])
        for i, albedo in enumerate(albedos):
            shares[i, lanes] = luminance(albedo)
        _limit(lobes, own, count, lanes, rest, sum(albedos))
    for i, k in own.items():
        lobes[i] = Lobe(lobes[i].bsdf, k)
    return reflection.with_lobes(lobes, shares)


def _limit(lobes, own, count, lanes, rest, total):
    """Darken all `lobes` at the points `lanes` where their albedo `total` (3, M) is more than the `rest` of light."""
    factor = np.where(total > rest, np.maximum(rest, 0) / total, np.float32(1)).min(axis=0)
    over = np.nonzero(factor < 1)[0]
    if not over.size:
        return
    for i, lobe in enumerate(lobes):
        if i not in own:
            own[i] = lobe.k.repeated(count)
        for name in _SCALES:
            if hasattr(own[i], name):
                getattr(own[i], name)[:, lanes.take(over)] *= factor.take(over)
