"""Media along a path: which bodies a ray is in, which boundaries are there, and what is absorbed on the way.

Every ray carries `inside`, (M + 1, N) int8: how often it is within each of the world's media, in the order of their rank; the
vacuum, last, is everywhere. The medium that is there is the first that has a count. A boundary of a medium changes
nothing where a stronger one, or one more body of the same, is on both of its sides: it is passed as if it were not
there (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images", Journal of Graphics Tools 7(2)). All
other boundaries are between the medium and the strongest of what is else around.
"""

import dataclasses

import numpy as np

from ..maths.vectors import dot
from ..world.interaction import leave_on_either_side
from .escape import light_hits, light_hits_beyond
from .records import Rays

MOST_BOUNDARIES = 1024
"""A ray is stopped by the next boundary after so many that are not there: rounding in a wedge cannot keep it forever."""
_UP = np.array([[0.0123], [0.0321], [0.9994]], np.float32)
"""Nearly: not along edges, which people align with axes. Upwards, so that a ray leaves even water without a bottom."""


def in_no_body(plan, rays):
    """The first column `inside` of what camera rays carry."""
    inside = np.zeros((plan.world.media.count + 1, rays.slot.size), np.int8)
    inside[-1] = 1
    return inside


def strongest(inside):
    """The media (N,) that are there."""
    return (inside > 0).argmax(axis=0)


def surrounding(inside, row, is_front):
    """The media (N,) that would be there without the body of the medium `row` (N,), -1: none, at whose boundary rays are."""
    found = inside > 0
    leaving = np.nonzero(~is_front & (row >= 0))[0]
    own = row.take(leaving)
    found[own, leaving] = inside[own, leaving] > 1
    return found.argmax(axis=0)


def _cross(inside, lanes, row, is_front):
    """Count the boundaries of media `row` (M,) that the rays `lanes` (M,) pass, entering where they meet the front."""
    inside[row, lanes] = np.maximum(inside[row, lanes] + np.where(is_front, 1, -1), 0)


def start_inside(closest):
    """The stage (plan, rays) that finds out where camera rays start: inside of what they leave more often than they enter.

    One ray upwards counts for all that start at one place. `closest` has to show every boundary.
    """

    def count_bodies(plan, rays):
        is_one = "time" not in vars(rays.carried) and (rays.o == rays.o[:, :1]).all()
        lanes = np.arange(1 if is_one else rays.slot.size)
        counts = np.zeros((plan.world.media.count, lanes.size), np.int8)
        o, carried = rays.o.take(lanes, axis=1), rays.carried.take(lanes)
        for _ in range(MOST_BOUNDARIES):
            walkers = _bare(carried, o, np.repeat(_UP, lanes.size, axis=1))
            hits = closest(plan, walkers.carried, walkers.o, walkers.d)
            met = np.nonzero(hits.prim >= 0)[0]
            if not met.size:
                break
            lanes, walkers = lanes.take(met), walkers.take(met)
            surface = plan.interact(plan, walkers, hits.take(met))
            row = plan.world.media.behind.take(surface.prim)
            found = np.nonzero(row >= 0)[0]
            counts[row.take(found), lanes.take(found)] += np.where(surface.is_front.take(found), -1, 1).astype(np.int8)
            o, carried = leave_on_either_side(surface, walkers.d), walkers.carried
        rays.carried.inside[:-1] = np.maximum(counts, 0)

    return count_bodies


def through_media(closest):
    """`closest` without boundaries that are not there. `carried.inside` is kept up to date with those that rays pass."""

    def closest_boundary(plan, carried, o, d, limit=None):
        hits = closest(plan, carried, o, d, limit)
        behind = plan.world.media.behind
        lanes = _within(behind, carried.inside, hits)
        for _ in range(MOST_BOUNDARIES):
            if not lanes.size:
                break
            inside, found = carried.inside.take(lanes, axis=1), hits.take(lanes)
            part = _bare(carried.take(lanes), o.take(lanes, axis=1), d.take(lanes, axis=1))
            surface = plan.interact(plan, part, found)
            row = behind.take(found.prim)
            passed = np.nonzero(surrounding(inside, row, surface.is_front) <= row)[0]
            lanes, t, start = lanes.take(passed), found.t.take(passed), leave_on_either_side(surface, part.d).take(passed, axis=1)
            _cross(carried.inside, lanes, row.take(passed), surface.is_front.take(passed))
            left = None if limit is None else limit.take(lanes) - t
            further = closest(plan, carried.take(lanes), start, part.d.take(passed, axis=1), left)
            hits.prim[lanes], hits.t[lanes], hits.u[lanes], hits.v[lanes] = further.prim, t + further.t, further.u, further.v
            lanes = lanes.take(_within(behind, carried.inside.take(lanes, axis=1), further))
        return hits

    return closest_boundary


def _within(behind, inside, hits):
    """The rays that are in a body and met the boundary of one: only there a boundary may be missing."""
    return np.nonzero((hits.prim >= 0) & (behind.take(hits.prim) >= 0) & (inside[:-1] > 0).any(axis=0))[0]


def occluded_in_media(occluded, closest):
    """`occluded`, where only boundaries count that are there: `closest` is that of `through_media`."""

    def is_occluded(plan, carried, o, d, limit):
        blocked = occluded(plan, carried, o, d, limit)
        lanes = np.nonzero(blocked & (carried.inside[:-1] > 0).any(axis=0))[0]
        if lanes.size:
            rest = closest(plan, carried.take(lanes), o.take(lanes, axis=1), d.take(lanes, axis=1), limit.take(lanes))
            blocked[lanes] = rest.prim >= 0
        return blocked

    return is_occluded


def relative_indices(plan, rays, surface, reflection):
    """The stage that gives boundaries their indices of refraction over those of what is around their bodies."""
    ior, _ = around(plan, rays, surface)
    return reflection.with_indices(lambda k: k.ior / ior, rays.slot.size)


def around(plan, rays, surface):
    """What is around the bodies at whose boundaries `rays` are: index of refraction (N,), and its spread (N,)."""
    media = plan.world.media
    row = surrounding(rays.carried.inside, media.behind.take(surface.prim), surface.is_front)
    return media.ior.take(row), media.spread.take(row)


def vacuum(plan, rays, surface):
    """`around` where bodies share no space: index 1 and spread 0."""
    return np.float32(1), np.float32(0)


def change_media(plan, rays, surface, reflection, scattered):
    """The stage that counts the boundaries which scattered rays pass."""
    row = plan.world.media.behind.take(surface.prim)
    lanes = np.nonzero((row >= 0) & (dot(surface.n, scattered.d) < 0))[0]
    # Other rays from the same surface share the column.
    scattered.carried.inside = scattered.carried.inside.copy()
    _cross(scattered.carried.inside, lanes, row.take(lanes), surface.is_front.take(lanes))


def pass_boundary(plan, rays, surface):
    """The stage that counts the boundaries which rays pass straight on."""
    row = plan.world.media.behind.take(surface.prim)
    lanes = np.nonzero(row >= 0)[0]
    _cross(rays.carried.inside, lanes, row.take(lanes), surface.is_front.take(lanes))


def transmitted(plan, inside, t):
    """Beer's law: the share of light (3, N) that is left after the ways t (N,) through the media that are there.

    Nothing is absorbed where there is nothing that absorbs or no way, also where the other one is infinite.
    """
    return np.fmin(np.exp(-plan.world.media.absorption.take(strongest(inside), axis=1) * t), 1)


def absorb(plan, rays, hits, film):
    """The stage that weakens rays on their way to what they hit."""
    lanes = np.nonzero(plan.world.media.absorbs.take(strongest(rays.carried.inside)))[0]
    if lanes.size:
        rays.beta[:, lanes] *= transmitted(plan, rays.carried.inside.take(lanes, axis=1), hits.t.take(lanes))


def add_light_hits_in_media(plan, rays, hits, film):
    """`add_light_hits`, weakened on the way."""
    for lanes, t, L, light in light_hits(plan, rays, hits):
        film.add(plan, rays, lanes, L * transmitted(plan, rays.carried.inside.take(lanes, axis=1), t), light, rays.depth)


def absorb_beyond(plan, rays, hits, film):
    """`absorb` on the way from the surface that rays have passed last."""
    absorb(plan, rays, dataclasses.replace(hits, t=hits.t - rays.carried.start), film)


def add_light_hits_in_media_beyond(plan, rays, hits, film):
    """`add_light_hits_in_media` beyond the surface that rays have passed last."""
    for lanes, t, L, light in light_hits_beyond(plan, rays, hits):
        way = t - rays.carried.start.take(lanes)
        film.add(plan, rays, lanes, L * transmitted(plan, rays.carried.inside.take(lanes, axis=1), way), light, rays.depth)


def left_by_media(plan, rays, t):
    """The share of light (3, N) that media leave over the ways t (N,) of `rays`."""
    return transmitted(plan, rays.carried.inside, t)


def absorbed(unblocked):
    """`unblocked` with the share that media leave of the shadow rays' light."""

    def unblocked_in_media(plan, rays, o, d, limit, candidate):
        lanes, share = unblocked(plan, rays, o, d, limit, candidate)
        return lanes, share * transmitted(plan, rays.carried.inside.take(lanes, axis=1), limit.take(lanes))

    return unblocked_in_media


def _bare(carried, o, d):
    """Rays that are nothing but a way."""
    return Rays(o, d, d, d[0], d[0], d[0], d[0], depth=0, carried=carried)
