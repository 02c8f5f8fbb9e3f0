"""Light from emissive meshes that rays run into."""

import numpy as np

from ..lights.triangle import triangle_pdf
from ..maths.vectors import dot
from .mis import power_heuristic


def add_emission(plan, rays, hits, film):
    """Emission where rays hit a mesh that emits, weighted against the shadow ray that could have found it."""
    triangles = plan.world.triangles
    lanes = np.nonzero(hits.prim >= 0)[0]
    prim = hits.prim[lanes]
    emitter = triangles.emitter[prim]
    shining = np.nonzero(emitter >= 0)[0]
    if not shining.size:
        return
    lanes, prim, emitter = lanes[shining], prim[shining], emitter[shining]
    L = plan.world.materials.emission[:, triangles.material[prim]] * rays.beta[:, lanes]
    if rays.depth:
        lights = plan.world.lights
        area, normal = plan.emitters.area[emitter], plan.emitters.normal[:, emitter]
        t = hits.t[lanes]
        cos = np.abs(dot(normal, rays.d[:, lanes]))
        with np.errstate(divide="ignore"):
            pdf = triangle_pdf(area * cos / (t * t)) * lights.probability[plan.world.first_emitter + emitter]
        L *= power_heuristic(rays.pdf[lanes], pdf)
    film.add(rays.slot[lanes], L)
