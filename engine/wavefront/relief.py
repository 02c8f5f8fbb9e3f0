"""Shading normals that textures bend.

Light from below the geometric surface is refused as for every shading normal; a bent normal that would itself point
below it is not used.
"""

import dataclasses

import numpy as np

from ..maths.facing import unit
from ..maths.vectors import dot
from .texturing import points_of


def bend_normals(plan, rays, surface):
    """The surface with the normals that the reliefs of its materials give it, one after the other."""
    points, ns, looked = points_of(plan, rays, surface), np.array(surface.ns), {}
    for row, reliefs in plan.world.materials.relief.items():
        lanes = np.nonzero(surface.material == row)[0]
        if not lanes.size:
            continue
        at = points.take(lanes)
        own = at.once("surface", lambda lanes=lanes: surface.take(lanes))
        looked[row] = lanes, at
        for i, relief in enumerate(reliefs):
            bent = np.broadcast_to((at.on(own) if i else at).value(relief), own.ns.shape)
            height = dot(bent, own.n)
            # Not where it is not a number either, or beyond all numbers; and what is the same keeps every bit.
            used = np.nonzero((bent != own.ns).any(axis=0) & (height > 0) & np.isfinite(height))[0]
            bent = bent.take(used, axis=1).astype(ns.dtype, copy=False)
            normals = np.array(own.ns)
            # Without their size first, whose square may be beyond all numbers.
            normals[:, used] = unit(bent / np.abs(bent).max(axis=0))
            own = dataclasses.replace(own, ns=normals)
        ns[:, lanes] = own.ns
    return dataclasses.replace(surface, ns=ns, looked=looked)
