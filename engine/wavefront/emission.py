"""Light from emissive meshes that rays run into."""

import numpy as np

from ..arrays import gather
from ..maths import patches
from ..maths.vectors import dot
from ..world.texturing import TexturePoints
from .mis import power_heuristic
from .views import RayView


def add_emission(plan, rays, hits, film):
    """Emission where rays hit a mesh that emits, weighted against the shadow ray that could have found it."""
    world, k = plan.world, plan.world.emitters.k
    lanes = np.nonzero((hits.prim >= world.triangles.first_emitter) & (hits.prim < world.triangles.first_moving))[0]
    if not lanes.size:
        return
    patch = gather(world.emitters.patch, gather(hits.prim, lanes) - world.triangles.first_emitter)
    index = world.lights.first_patch + patch
    L = gather(k.radiance, patch) * gather(rays.beta, lanes)
    L = plan.shine(plan, rays, hits, lanes, L)
    if rays.depth:
        cos = np.abs(dot(gather(k.normal, patch), gather(rays.d, lanes)))
        t = gather(hits.t, lanes)
        pdf = patches.pdf(gather(k.area, patch) * cos / (t * t))
        pdf *= world.lights.chance(index, rays, lanes)
        L *= power_heuristic(gather(rays.pdf, lanes), pdf)
    film.add(plan, rays, lanes, L, index, rays.depth)


def even_shine(plan, rays, hits, lanes, L):
    """Radiance L (3, M) of emitters where the rays `lanes` (M,) have met them, as it is there: everywhere the same."""
    return L


def textured_shine(plan, rays, hits, lanes, L):
    """The same where emission may be textured."""
    prim, d = gather(hits.prim, lanes), gather(rays.d, lanes)
    across = plan.footprints(plan, rays.carried.take(lanes), prim, -d, gather(hits.t, lanes))
    view = RayView(plan, rays, hits.t.take(lanes), lanes)
    return plan.world.glow.seen(L, TexturePoints(plan.world.attributes, prim, hits.u.take(lanes), hits.v.take(lanes), view, across))
