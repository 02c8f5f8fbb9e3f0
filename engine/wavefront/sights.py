"""Rays that meet what their kind sees, where things are hidden from some kinds; see `world.sights`."""

from types import SimpleNamespace

import numpy as np

from ..scene.visibility import RAY_KINDS
from ..world.accel import Hits
from ..world.sights import SHADOW
from .light_path import kind_of
from .splitting import shares

_LOBES = [[RAY_KINDS.index(kind)] for kind in ("diffuse", "glossy", "transmission")]


def closest_in_sight(plan, carried, o, d, limit=None):
    """As `visibility.closest`, among what the kind of each ray sees."""
    sights, time = plan.world.sights, getattr(carried, "time", None)
    own = sights.of_kind.take(kind_of(carried))
    present = np.nonzero(np.bincount(own, minlength=1))[0]
    if present.size == 1:
        return sights.sights[present[0]].closest(o, d, limit, time)
    hits = Hits(np.full(own.size, -1, np.int32), *np.zeros((3, own.size), o.dtype))
    for number in present:
        lanes = np.nonzero(own == number)[0]
        rest, when = (None if column is None else column.take(lanes) for column in (limit, time))
        found = sights.sights[number].closest(o.take(lanes, axis=1), d.take(lanes, axis=1), rest, when)
        hits.prim[lanes], hits.t[lanes], hits.u[lanes], hits.v[lanes] = found.prim, found.t, found.u, found.v
    return hits


def closest_to_shadows(plan, carried, o, d, limit=None):
    """The same for shadow rays."""
    return _of_shadows(plan).closest(o, d, limit, getattr(carried, "time", None))


def occluded_to_shadows(plan, carried, o, d, limit):
    """As `visibility.occluded`, by what shadow rays see."""
    return _of_shadows(plan).occluded(o, d, limit, getattr(carried, "time", None))


def lit_by(add_light):
    """The stage `add_light` for rays that lights are hidden from: light objects, what emits, and the world."""

    def add_seen_light(plan, rays, hits, film):
        add_light(plan, rays, hits, SimpleNamespace(add=_of_seen(film.add), record=_of_seen(film.record)))

    return add_seen_light


def _of_seen(add):
    def add_seen(plan, rays, lanes, L, light, bounces):
        seen = plan.world.sights.lit[kind_of(rays.carried).take(lanes), 0 if light is None else light]
        add(plan, rays, lanes, L * seen, light, bounces)

    return add_seen


def lit_lobes(plan, surface, reflection, wi, L, light):
    """What is left of the light L (3, N) that `surface` reflects from lights along wi (3, N): by lobes that they are not hidden from."""
    lit = plan.world.sights.lit[_LOBES, 0 if light is None else light].reshape(len(_LOBES), 1, -1)
    if lit.all():
        return L
    diffuse, glossy = shares(surface, reflection, wi)
    # To the bit what it is where nothing is hidden, whatever else is in the batch.
    return np.where(lit.all(axis=0), L, L * (diffuse * lit[0] + glossy * lit[1] + (1 - diffuse - glossy) * lit[2]))


def stay_of_kind(plan, rays, surface, reflection, scattered):
    """The stage that has rays that go straight on, to the last bit, stay of their kind, where they count as scattered."""
    is_straight = (scattered.d == rays.d).all(axis=0)
    scattered.carried.scattered = np.where(is_straight, rays.carried.scattered, scattered.carried.scattered)


def _of_shadows(plan):
    sights = plan.world.sights
    return sights.sights[sights.of_kind[SHADOW]]
