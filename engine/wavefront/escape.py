"""Light that rays find beyond or before the geometry."""

import numpy as np

from .mis import power_heuristic


def add_background(plan, rays, hits, film):
    """Rays that met nothing see the world. It is found by scattered rays alone, so it needs no weight."""
    lanes = np.nonzero(hits.prim < 0)[0]
    film.add(rays.slot.take(lanes), rays.beta.take(lanes, axis=1) * plan.world.background)


def add_environment(plan, rays, hits, film):
    """Rays that met nothing see the picture around the scene, weighted against the shadow ray that could have found it."""
    lanes = np.nonzero(hits.prim < 0)[0]
    if not lanes.size:
        return
    lights, d = plan.world.lights, rays.d.take(lanes, axis=1)
    if rays.depth:
        L, pdf = lights.environment.hit(d)
        chosen = lights.choice.probability(np.full(lanes.size, lights.first_patch - 1), rays.o.take(lanes, axis=1))
        L *= power_heuristic(rays.pdf.take(lanes), pdf * chosen)
    else:
        L = lights.environment.radiance(d)
    L *= rays.beta.take(lanes, axis=1)
    film.add(rays.slot.take(lanes), L)


def add_light_hits(plan, rays, hits, film):
    """Light objects nearer than the geometry; they do not hide what is behind them."""
    for lanes, _, L in light_hits(plan, rays, hits):
        film.add(rays.slot.take(lanes), L)


def add_light_hits_beyond(plan, rays, hits, film):
    """The same beyond the surface that rays have passed last."""
    for lanes, _, L in light_hits_beyond(plan, rays, hits):
        film.add(rays.slot.take(lanes), L)


def light_hits(plan, rays, hits):
    """For each light object that rays meet: which rays (M,), how far away (M,), and the radiance (3, M) that counts."""
    return _lamps(plan, rays, lambda t: t < hits.t)


def light_hits_beyond(plan, rays, hits):
    """The same beyond the surface that rays have passed last: `rays.carried.start` (N,) is how far away it is."""
    return _lamps(plan, rays, lambda t: (t < hits.t) & (t >= rays.carried.start))


def _lamps(plan, rays, is_met):
    for lamp in plan.world.lights.hittable if rays.depth else plan.world.lights.visible:
        t, L, pdf = lamp.light.hit(lamp.k, rays.o, rays.d)
        lanes = np.nonzero(is_met(t))[0]
        if not lanes.size:
            continue
        L = np.broadcast_to(L, rays.d.shape).take(lanes, axis=1) * rays.beta.take(lanes, axis=1)
        if rays.depth:
            chosen = plan.world.lights.choice.probability(np.full(lanes.size, lamp.index), rays.o.take(lanes, axis=1))
            light_pdf = np.broadcast_to(pdf, t.shape).take(lanes) * chosen
            L *= power_heuristic(rays.pdf.take(lanes), light_pdf)
        yield lanes, t.take(lanes), L
