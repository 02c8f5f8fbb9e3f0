"""Light from emissive meshes that rays run into."""

import numpy as np

from ..lights.triangle import triangle_pdf
from ..maths.vectors import dot
from .mis import power_heuristic


def add_emission(plan, rays, hits, film):
    """Emission where rays hit a mesh that emits, weighted against the shadow ray that could have found it."""
    world = plan.world
    lanes = np.nonzero(hits.prim >= world.triangles.first_emitter)[0]
    if not lanes.size:
        return
    emitter = hits.prim.take(lanes) - world.triangles.first_emitter
    L = world.emitters.radiance.take(emitter, axis=1) * rays.beta.take(lanes, axis=1)
    if rays.depth:
        cos = np.abs(dot(world.emitters.normal.take(emitter, axis=1), rays.d.take(lanes, axis=1)))
        t = hits.t.take(lanes)
        index = world.lights.groups[-1].first + emitter
        pdf = triangle_pdf(world.emitters.area.take(emitter) * cos / (t * t))
        pdf *= world.lights.choice.probability(index, rays.o.take(lanes, axis=1))
        L *= power_heuristic(rays.pdf.take(lanes), pdf)
    film.add(rays.slot.take(lanes), L)
