"""Stages for what moves while the shutter is open: every path has a time, and meets the scene as it is then."""

from dataclasses import replace

import numpy as np

from ..constants import EPS32
from ..dimensions import Dimension
from ..maths import patches
from ..maths.vectors import dot
from ..world.interaction import START_ULPS, interact
from . import visibility
from .clip import range_along
from .mis import power_heuristic

TIME = "time"
"""The column of the time (N,) in [0, 1) that paths carry, from the opening of the shutter to its closing."""


def start_time(plan, rays):
    """The times of new paths, spread evenly over those of a pixel."""
    return plan.numbers.one(rays, Dimension.TIME)


def follow_camera(plan, rays):
    """Camera rays, aimed from where the camera is at the middle of the shutter, start from where it is at their time."""
    pose = plan.camera_poses.at(0, rays.time)
    rays.o[...], rays.d[...] = pose.points(rays.o), pose.vectors(rays.d)


def seen_from_camera(plan, rays, p):
    """Points p (3, N) of render space as the camera sees them at the time of `rays`: moved to its place at the middle of the shutter."""
    return plan.camera_poses.at(0, rays.time).local_points(p).astype(p.dtype)


def to_the_end_of_moving_range(plan, rays):
    """As `clip.to_the_end_of_range`, for a camera that moves."""
    if rays.depth:
        return None
    return range_along(plan, plan.camera_poses.at(0, rays.time).local_vectors(rays.d).astype(rays.d.dtype))


def closest_at_time(plan, carried, o, d, limit=None):
    """As `visibility.closest`, among what stands still and what moves."""
    hits = visibility.closest(plan, carried, o, d, limit)
    return plan.world.movers.meet(hits, o, d, carried.time)


def occluded_at_time(plan, carried, o, d, limit):
    """As `visibility.occluded`, by what stands still and what moves."""
    blocked = visibility.occluded(plan, carried, o, d, limit)
    return plan.world.movers.block(blocked, o, d, limit, carried.time)


def interact_at_time(plan, rays, hits):
    """As `visibility.interact_at_rest`; what moves is met in its own frame, and carried into render space.

    Rays start above a moving triangle in proportion to the rounding of p in both frames, and of the triangle; what the
    local frame asks for is |det A| / |cof(A) n| as high in render space.
    """
    world, movers = plan.world, plan.world.movers
    lanes = np.nonzero(hits.prim >= movers.first)[0]
    if not lanes.size:
        return visibility.interact_at_rest(plan, rays, hits)
    prim, d = hits.prim.take(lanes), rays.d.take(lanes, axis=1)
    pose = movers.poses.at(movers.owner.take(prim - movers.first), rays.time.take(lanes))
    local_d = np.array(rays.d)
    local_d[:, lanes] = pose.local_vectors(d)
    surface = interact(world.triangles, plan.shading_normals, local_d, hits)
    local_p = surface.p.take(lanes, axis=1)
    p = pose.points(local_p).astype(local_p.dtype)
    n, growth = pose.normals(surface.n.take(lanes, axis=1))
    ns, _ = pose.normals(surface.ns.take(lanes, axis=1))
    height = np.abs(local_p).max(axis=0) + world.triangles.extent.take(prim)
    if not pose.is_rigid:
        height *= np.abs(pose.volume()) / growth
    height = START_ULPS * EPS32 * (height + np.abs(p).max(axis=0))
    surface.p[:, lanes], surface.wo[:, lanes] = p, -d
    surface.o[:, lanes] = p + height * n
    return replace(surface, n=_with(surface.n, lanes, n), ns=_with(surface.ns, lanes, ns))


def _with(vectors, lanes, values):
    """`vectors` (3, N), which may be shared, with other values (3, M) in `lanes`."""
    result = np.array(vectors)
    result[:, lanes] = values
    return result


def add_moving_emission(plan, rays, hits, film):
    """As `emission.add_emission`, where rays hit a moving mesh that emits."""
    world, lamps = plan.world, plan.world.emitters.moving
    lanes = np.nonzero(hits.prim >= world.movers.first)[0]
    lamp = lamps.lamp.take(hits.prim.take(lanes) - world.movers.first)
    lanes, lamp = lanes[lamp >= 0], lamp[lamp >= 0]
    index = world.lights.first_patch + world.emitters.still + lamp
    L = plan.shine(plan, rays, hits, lanes, lamps.radiance.take(lamp, axis=1) * rays.beta.take(lanes, axis=1))
    if rays.depth and lanes.size:
        k, t = lamps.at(lamp, rays.time.take(lanes)), hits.t.take(lanes)
        pdf = patches.pdf(k.area * np.abs(dot(k.normal, rays.d.take(lanes, axis=1))) / (t * t))
        pdf *= world.lights.chance(index, rays, lanes)
        L *= power_heuristic(rays.pdf.take(lanes), pdf)
    film.add(plan, rays, lanes, L, index, rays.depth)
