"""Light that rays find beyond or before the geometry."""

import numpy as np

from .film import BACKGROUND
from .mis import power_heuristic

_FARTHEST = np.finfo(np.float32).max
"""Where suns are."""


def add_background(plan, rays, hits, film):
    """Rays that met nothing see the world. It is found by scattered rays alone, so it needs no weight."""
    lanes = np.nonzero(hits.prim < 0)[0]
    film.add(plan, rays, lanes, rays.beta.take(lanes, axis=1) * plan.world.background, BACKGROUND, rays.depth)


def add_environment(plan, rays, hits, film):
    """Rays that met nothing see the picture around the scene, weighted against the shadow ray that could have found it."""
    lanes = np.nonzero(hits.prim < 0)[0]
    if not lanes.size:
        return
    lights, d = plan.world.lights, rays.d.take(lanes, axis=1)
    index = lights.first_patch - 1
    if rays.depth:
        L, pdf = lights.environment.hit(d)
        chosen = lights.chance(np.full(lanes.size, index), rays, lanes)
        L *= power_heuristic(rays.pdf.take(lanes), pdf * chosen)
    else:
        L = lights.environment.radiance(d)
    L *= rays.beta.take(lanes, axis=1)
    film.add(plan, rays, lanes, L, index, rays.depth)


def add_light_hits(plan, rays, hits, film):
    """Light objects nearer than the geometry; they do not hide what is behind them."""
    for lanes, _, L, light in light_hits(plan, rays, hits):
        film.add(plan, rays, lanes, L, light, rays.depth)


def add_light_hits_beyond(plan, rays, hits, film):
    """The same beyond the surface that rays have passed last."""
    for lanes, _, L, light in light_hits_beyond(plan, rays, hits):
        film.add(plan, rays, lanes, L, light, rays.depth)


def light_hits(plan, rays, hits):
    """For each light object that rays meet: which rays (M,), how far away (M,), the radiance (3, M) that counts, and its place."""
    return _lamps(plan, rays, np.float32(0), hits)


def light_hits_beyond(plan, rays, hits):
    """The same beyond the surface that rays have passed last: `rays.carried.start` (N,) is how far away it is."""
    return _lamps(plan, rays, rays.carried.start, hits)


def _lamps(plan, rays, near, hits):
    """The lamps at a distance from near on, (N,) or a number, to before the hits; a sun is beyond the end of any clip range."""
    lights = plan.world.lights
    if rays.depth:
        search, lanes = lights.hittable, lights.looks_for_lamps(rays.pdf)
    else:
        search, lanes = lights.visible, None
    for lamp, asked in search.along(rays.o, rays.d, lanes):
        t, L, pdf = lamp.light.hit(lamp.k, _of(asked, rays.o), _of(asked, rays.d))
        is_before = (t < _of(asked, hits.t)) | ((t == _FARTHEST) & (_of(asked, hits.prim) < 0))
        met = np.nonzero(is_before & (t >= _of(asked, near)))[0]
        if not met.size:
            continue
        lanes_met = met if asked is None else asked.take(met)
        L = np.broadcast_to(L, (3, t.size)).take(met, axis=1) * rays.beta.take(lanes_met, axis=1)
        L = lights.groups[lamp.group].glow.met(L, lamp.k, rays, lanes_met, t.take(met))
        if rays.depth:
            chosen = lights.chance(np.full(met.size, lamp.index), rays, lanes_met)
            light_pdf = np.broadcast_to(pdf, t.shape).take(met) * chosen
            L *= power_heuristic(rays.pdf.take(lanes_met), light_pdf)
        yield lanes_met, t.take(met), L, lamp.index


def _of(lanes, column):
    """The `lanes` (M,) of a column, None: all; a number is the same for all."""
    return column if lanes is None or np.ndim(column) == 0 else column.take(lanes, axis=-1)
