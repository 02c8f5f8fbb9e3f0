"""Light from emissive meshes that rays run into."""

import numpy as np

from ..maths import patches
from ..maths.vectors import dot
from .mis import power_heuristic


def add_emission(plan, rays, hits, film):
    """Emission where rays hit a mesh that emits, weighted against the shadow ray that could have found it."""
    world, k = plan.world, plan.world.emitters.k
    lanes = np.nonzero((hits.prim >= world.triangles.first_emitter) & (hits.prim < world.triangles.first_moving))[0]
    if not lanes.size:
        return
    patch = world.emitters.patch.take(hits.prim.take(lanes) - world.triangles.first_emitter)
    L = k.radiance.take(patch, axis=1) * rays.beta.take(lanes, axis=1)
    if rays.depth:
        cos = np.abs(dot(k.normal.take(patch, axis=1), rays.d.take(lanes, axis=1)))
        t = hits.t.take(lanes)
        pdf = patches.pdf(k.area.take(patch) * cos / (t * t))
        pdf *= world.lights.choice.probability(world.lights.first_patch + patch, rays.o.take(lanes, axis=1))
        L *= power_heuristic(rays.pdf.take(lanes), pdf)
    film.add(rays.slot.take(lanes), L)
