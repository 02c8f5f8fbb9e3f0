"""Values of textures in the columns that they stand for."""

import numpy as np

from ..scene.textured import luminance
from .materials import Lobe
from .texturing import clean

_SCALES = ("reflectance", "transmittance")
"""The parameters to which the albedo of a lobe is in proportion."""


def filled_in(materials, reflection, count, met):
    """The `reflection` of `count` points with the values of textures, where materials have them.

    `met` yields (row of the `materials`, lanes, `Points`) where each is. There the lobes together reflect at most what does not
    pass straight on, and are chosen by what they reflect.
    """
    lobes = [*reflection.rough, *reflection.specular]
    own, shares = {}, np.ones((1, 1), np.float32)
    if len(lobes) > 1:
        shares = np.array(np.broadcast_to(reflection.shares, (len(lobes), count)))
    for row, lanes, at in met:
        for t in materials.textured[row]:
            if t.lobe not in own:
                own[t.lobe] = lobes[t.lobe].k.repeated(count)
            getattr(own[t.lobe], t.column)[..., lanes] = t.value(at)
        tables = [own.get(i, lobe.k).pick(lanes) for i, lobe in enumerate(lobes)]
        albedos = [lobe.bsdf.albedo(k) for lobe, k in zip(lobes, tables)]
        rest = 1 - sum(np.minimum(clean(at.value(passed)), 1) for passed in materials.straight[row])
        for i, albedo in enumerate(albedos) if len(lobes) > 1 else ():
            shares[i, lanes] = luminance(albedo)
        _limit(lobes, own, count, lanes, rest, sum(albedos))
    for i, k in own.items():
        lobes[i] = Lobe(lobes[i].bsdf, k)
    return reflection.with_lobes(lobes, shares)


def _limit(lobes, own, count, lanes, rest, total):
    """Darken all `lobes` at the points `lanes` where their albedo `total` (3, M or 1) is more than the `rest` of light."""
    is_over = total > rest
    if not is_over.any():
        return
    factor = np.where(is_over, np.maximum(rest, 0) / total, np.float32(1)).min(axis=0)
    factor = np.broadcast_to(factor, lanes.shape)
    over = np.nonzero(factor < 1)[0]
    if not over.size:
        return
    for i, lobe in enumerate(lobes):
        if i not in own:
            own[i] = lobe.k.repeated(count)
        for name in _SCALES:
            if hasattr(own[i], name):
                getattr(own[i], name)[:, lanes.take(over)] *= factor.take(over)
