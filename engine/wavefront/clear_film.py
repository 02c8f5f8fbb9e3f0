"""A film that stays clear where the world is: camera rays do not see it, all others do (`Settings.film_transparent`).

What transparent surfaces let pass of a camera ray, on average over its channels, is how clear the film stays. Alpha is the rest.
"""

from types import SimpleNamespace

import numpy as np

STRAIGHT = "straight"
"""The column (N,) bool of rays that come straight from the camera, where rays that pass a surface straight on count as scattered."""


def straight_at_first(plan, rays):
    """The first column `straight` of what camera rays carry."""
    return np.ones(rays.slot.size, bool)


def stay_straight(plan, rays, surface, reflection, scattered):
    """The stage that has scattered rays know whether they still go the way of the camera ray: to the last bit."""
    scattered.carried.straight = rays.carried.straight & (scattered.d == rays.d).all(axis=0)


def stay_clear(plan, rays, hits, film):
    """Rays straight from the camera that met nothing leave the film clear."""
    lanes = np.nonzero(getattr(rays.carried, STRAIGHT, not rays.depth) & (hits.prim < 0))[0]
    film.clear[0, rays.slot.take(lanes)] += rays.beta.take(lanes, axis=1).mean(axis=0)


def hidden(add_world):
    """The stage `add_world` whose light is not shown to rays straight from the camera; passes have it, as in Cycles."""

    def add_hidden_world(plan, rays, hits, film):
        unseen = SimpleNamespace(add=film.record)
        is_straight = getattr(rays.carried, STRAIGHT, None)
        if is_straight is None:
            add_world(plan, rays, hits, film if rays.depth else unseen)
            return
        for lanes, into in ((np.nonzero(~is_straight)[0], film), (np.nonzero(is_straight)[0], unseen)):
            add_world(plan, rays.take(lanes), hits.take(lanes), into)

    return add_hidden_world
