"""Straight through transparent surfaces: paths pass or stay by chance, shadow rays are weakened.

Passing is no bounce: direction, density and origin of a ray stay what they were, and distances are measured from that
origin. So light found beyond is weighed against the shadow ray from the same origin as if nothing stood between (Veach
1997, section 9.2: both ways to sample it bring the same transmittance, and their weights still add up to 1).

Rays start anew behind each surface, lifted off it as refracted rays are. Surfaces that lie closer together than that,
16 units in the last place of their coordinates, count once. A ray passes at most `max_transparent` surfaces between two
bounces; the next one absorbs what it should let pass, as it does for shadow rays.
"""

import dataclasses
from functools import partial

import numpy as np

from ..arrays import Columns
from ..dimensions import Dimension
from ..maths.vectors import dot, length
from ..scene.textured import luminance
from ..world.interaction import leave_on_either_side
from ..world.texturing import TexturePoints, clean
from .clear_film import STRAIGHT
from .texturing import points_of
from .views import RayView
from .visibility import blocked, travel

_NEXT_TURN = 2**20
"""Between the numbers that decide at one surface and at the next of the same ray; bounces need less."""


def travel_through(plan, rays, film):
    """`visibility.travel` to the surfaces where rays stay; rays.beta is weighed, in place, by what they passed.

    Of what a surface reflects and lets pass one is followed: with probability p what passes, which counts 1 / p, else what
    is reflected, which counts 1 / (1 - p). p is the share that passes of all the light that this path would bring; so a
    path that is paid for once more at every surface never grows, whatever the colours. What a surface emits is seen in
    any case. Rays of which nothing is left meet nothing.
    """
    hits = travel(plan, rays, film)
    part, met, lanes, turn = rays, hits, np.arange(hits.prim.size), 0
    passing = _decide(plan, part, met, turn)
    while passing.size and turn < plan.settings.max_transparent:
        turn += 1
        lanes = lanes.take(passing)
        part, met = _travel_beyond(plan, part.take(passing), met.take(passing), film)
        passing = _decide(plan, part, met, turn)
        rays.beta[:, lanes] = part.beta
        for name, column in vars(rays.carried).items():
            column[..., lanes] = getattr(part.carried, name)
        hits.prim[lanes], hits.t[lanes], hits.u[lanes], hits.v[lanes] = met.prim, met.t, met.u, met.v
    hits.prim[lanes.take(passing)] = -1
    return hits


def _decide(plan, rays, hits, turn):
    """The rays that pass the surface that they met, their indices; rays.beta is weighed by the decision."""
    table, met = plan.world.passing, np.nonzero(hits.prim >= 0)[0]
    material = plan.world.triangles.material.take(hits.prim.take(met))
    clear = np.nonzero(table.is_clear.take(material))[0]
    lanes, material = met.take(clear), material.take(clear)
    alpha, clear = _looked_up(plan, rays, hits, lanes, material, table.transmittance, table.veils)
    beta = rays.beta.take(lanes, axis=1)
    kept = beta * alpha
    passed = beta * (1 - alpha) + kept * clear
    p = passed.sum(axis=0)
    # What passes and what is reflected are at most all that arrives.
    total = p + dot(kept, np.minimum(table.albedo.take(material, axis=1), 1 - clear))
    p /= np.where(total > 0, total, 1)
    # Where nothing else goes on there is nothing to decide.
    u1 = 0 if (p == 1).all() else plan.numbers.one(rays, Dimension.PASS + _NEXT_TURN * turn).take(lanes)
    passes = u1 < p
    rays.beta[:, lanes] = np.where(passes, passed / p, kept / (1 - p))
    return lanes[passes]


def _looked_up(plan, rays, hits, lanes, material, passed, textures, is_shadow=False):
    """The share (M,) of the surfaces of `material` (M,) that is there, where the rays `lanes` (M,) met them, and what of it passes.

    The latter, (3, M), are the columns of `passed`, plus `textures` {row: textures} where there are any. Shadow rays stand for
    nothing but themselves: on average it is the same.
    """
    table = plan.world.passing
    alpha, clear = table.alpha.take(material), passed.take(material, axis=1)
    for row in dict.fromkeys((*table.cutouts, *textures)):
        own = np.nonzero(material == row)[0]
        if not own.size:
            continue
        at = lanes.take(own)
        prim, u, v = (column.take(at) for column in (hits.prim, hits.u, hits.v))
        t, d = hits.t.take(at), rays.d.take(at, axis=1)
        across = None if is_shadow else plan.footprints(plan, rays.carried.take(at), prim, -d, t)
        points = TexturePoints(plan.world.attributes, prim, u, v, RayView(plan, rays, t, at, is_shadow), across)
        if row in table.cutouts:
            alpha[own] = np.minimum(luminance(clean(points.value(table.cutouts[row]))), 1)
        for texture in textures.get(row, ()):
            clear[:, own] = np.minimum(clear[:, own] + clean(points.value(texture)), 1)
    return alpha, clear


def _travel_beyond(plan, rays, hits, film):
    """`rays` and `Hits` of what lies beyond `hits`; light met on the way goes into the film."""
    o = _behind(plan, rays, hits)
    gone = dot(o - rays.o, rays.d)
    limit = plan.reach(plan, rays)
    beyond = plan.closest(plan, rays.carried, o, rays.d, None if limit is None else limit - gone)
    beyond.t[...] += gone
    rays.carried.start = hits.t
    for add_light in plan.on_rays_beyond:
        add_light(plan, rays, beyond, film)
    return rays, beyond


def _behind(plan, rays, hits):
    """Where `rays` (3, N) start anew behind the surfaces that they met; what they carry is renewed."""
    # They have not landed there, whatever they carry as if they had.
    surface = plan.interact(plan, dataclasses.replace(rays, carried=Columns(**vars(rays.carried))), hits)
    for stage in plan.on_passing:
        stage(plan, rays, surface)
    return leave_on_either_side(surface, rays.d)


def opacity(plan, rays, surface):
    """The share (N,) of a pixel that a `surface` covers where camera `rays` have stayed: on average what does not go straight on."""
    table, share = plan.world.passing, rays.beta.mean(axis=0)
    if table is None:
        return share
    clear = table.straight.take(surface.material, axis=1)
    for row, textures in table.shades.items():
        own = np.nonzero(surface.material == row)[0]
        if own.size:
            points = points_of(plan, rays, surface).take(own).met(partial(surface.take, own))
            for texture in textures:
                clear[:, own] = np.minimum(clear[:, own] + clean(points.value(texture)), 1)
    return share * (1 - clear.mean(axis=0))


def record_beyond(passes):
    """The stage that has `passes` record what camera rays hit beyond surfaces where what goes straight on was a ray of its own."""

    def record(plan, rays, surface, reflection, film):
        lanes = np.nonzero(getattr(rays.carried, STRAIGHT))[0] if rays.depth else ()
        for p in passes if len(lanes) else ():
            film.meet(p, rays.slot.take(lanes), p.values(plan, rays, surface, reflection).take(lanes, axis=1))

    return record


def unblocked_through(plan, rays, o, d, limit, candidate):
    """`visibility.unblocked` with light that transparent surfaces weaken."""
    is_blocked = blocked(plan, rays.carried, o, d, limit, candidate)
    shut = np.nonzero(candidate & is_blocked)[0]
    share = np.zeros_like(o)
    clear = np.nonzero(candidate & ~is_blocked)[0]
    share[:, clear] = plan.left(plan, rays.landed(clear), limit.take(clear))
    towards = d.take(shut, axis=1)
    shadow = dataclasses.replace(rays.landed(shut), d=towards)
    share[:, shut] = _transmittance(plan, shadow, o.take(shut, axis=1), towards, limit.take(shut))
    lanes = np.nonzero(share.any(axis=0))[0]
    return lanes, share.take(lanes, axis=1)


def _transmittance(plan, rays, o, d, limit):
    """The share of light (3, N) that passes everything within `limit` (N,) from o along d (3, N), for each of `rays`."""
    table, materials = plan.world.passing, plan.world.triangles.material
    share = np.ones_like(o)
    lanes, at, towards, rest = np.arange(limit.size), o, d, limit
    for _ in range(plan.settings.max_transparent + 1):
        hits = plan.closest_to_shadows(plan, rays.carried, at, towards, rest)
        share[:, lanes] *= plan.left(plan, rays, hits.t)
        met = np.nonzero(hits.prim >= 0)[0]
        material = materials.take(hits.prim.take(met))
        alpha, shadow = _looked_up(plan, rays, hits, met, material, table.shadow, table.shades, is_shadow=True)
        tint = 1 - alpha + alpha * shadow
        share[:, lanes.take(met)] *= tint
        on = met[tint.any(axis=0)]
        lanes, hits, towards = lanes.take(on), hits.take(on), towards.take(on, axis=1)
        if not lanes.size:
            return share
        rays = dataclasses.replace(rays.landed(on), d=towards)
        at = _behind(plan, rays, hits)
        towards, rest = _aimed(at - o.take(lanes, axis=1), d.take(lanes, axis=1), limit.take(lanes))
    share[:, lanes] = 0
    return share


def _aimed(gone, d, limit):
    """Direction (3, N) and distance (N,), negative when it is passed, of the point `limit` (N,) along d, seen from `gone` (3, N).

    Aimed anew, as rays that start off their line might run into the light that they should end before. In shares of
    `limit`, which may be infinite.
    """
    towards = d - gone / limit
    share = length(towards)
    towards /= share
    return towards, np.where(dot(towards, d) > 0, share * limit, np.float32(-1))
