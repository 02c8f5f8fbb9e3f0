"""The plane in segments around the origin, each with coordinates of its own along and across the sides of rounded polygons.

As Blender's Radial Tiling has them. A polygon's sides are at the distance 1; whole numbers of `sides` make them all alike, else the
last one is shorter and farther away. Corners are arcs of circles, and nothing but arcs at the `roundness` 1. All numbers are float32 (N,).
"""

from typing import NamedTuple

import numpy as np

from .arithmetic import divided

_TURN, _HALF = np.float32(2 * np.pi), np.float32(np.pi)


class Tiles(NamedTuple):
    """u along the side, v across it, the width of the segment where v is that of the side, and the angle [rad] of its middle."""

    u: np.ndarray
    v: np.ndarray
    width: np.ndarray
    rotation: np.ndarray


def segment_number(x, y, sides):
    """Which segment x, y is in, counted from 0 at the x axis on, counter-clockwise."""
    return np.floor(sides * (np.arctan2(y, x) / _TURN + (y < 0)))


def tiles(x, y, sides, roundness, is_normalized):
    """The `Tiles` of points x, y; `sides` from 2 on, `roundness` from 0 to 1.

    is_normalized: u goes from 0 to 1 in each segment and v is 0 at the origin, else u is 0 in the middle and v on the side.
    """
    distance, angle = np.hypot(x, y), np.arctan2(y, x) + (y < 0) * _TURN
    half = _HALF / sides
    # Two sides are a strip, or a circle, and nothing in between.
    is_strip = (sides == 2) & (roundness < 1)
    roundness = np.where(is_strip, np.float32(0), roundness)
    number = np.floor(angle / (2 * half))
    inside = angle - number * (2 * half)
    # The last segment of a broken number of sides, and the halves of its neighbours on the other side of its corners.
    last = np.where(sides == np.floor(sides), np.float32(0), _HALF - np.floor(sides) * half)
    begin = _TURN - 2 * last
    is_last = (last > 0) & (angle >= begin)
    is_beside = (last > 0) & ~is_last & ((angle < half) | (angle >= begin - half))
    middle = np.where(is_last, last, half)
    stretch = np.where(is_last, np.cos(half) / np.cos(last), np.float32(1))
    # How far the nearer end of the segment is.
    corner = np.where(inside > middle, 2 * middle - inside, inside)
    # The angle from a corner at which its arc ends; the arc's centre, seen from that corner, and radius.
    bend = np.where(is_strip, np.float32(0), _bend(middle, roundness))
    end, roundness_beside, centre, radius = _odd_corner(half, last, roundness)
    ends = np.where(is_beside, end, bend)
    is_odd = is_last | is_beside
    centre = np.where(is_odd, centre[0], (1 - roundness) / np.cos(half)), np.where(is_odd, centre[1], np.float32(0))
    reach = _reach(np.where(is_last, -corner, corner), *centre, np.where(is_odd, radius, roundness))
    is_round = corner < ends
    across = np.where(is_round, divided(distance, reach), distance * np.cos(middle - inside))
    across = np.where(is_round & is_beside, across * (np.cos(half) / np.cos(last)), across)
    shape = middle - ends, ends, np.where(is_beside, roundness_beside, roundness)
    along = np.where(is_round, _along_arc(distance, ends - corner, *shape), across * np.tan(np.abs(middle - inside)))
    if is_normalized:
        share = np.where(is_round, divided(ends - corner, ends), np.float32(0))
        at_side, at_point = (_half_width(level, *shape) for level in (across, distance * np.cos(shape[0])))
        along = np.where(is_strip, along, divided(along, at_side + share * (at_point - at_side)))
    else:
        along = along * stretch
    along = np.where((x == 0) & (y == 0), np.float32(0), np.where(inside < middle, -along, along))
    spline = (1 - roundness) * bend
    width = np.tan(middle - bend) + spline * (np.float32(0.5) + np.float32(0.5) * stretch) + stretch * roundness * bend
    u, v = (np.float32(0.5) * along + np.float32(0.5), across * stretch) if is_normalized else (along, across * stretch - 1)
    return Tiles(u, v, np.where(is_strip, np.float32(0), width), number * (2 * half) + middle)


def _bend(half, roundness):
    """The angle from a corner to the end of its arc."""
    return half - np.arctan((1 - roundness) * np.tan(half))


def _odd_corner(half, last, roundness):
    """Of the corners of the last segment: where the arc ends beside it, how round that is, and the arc's centre and radius."""
    bend = _bend(last, roundness)
    radius = roundness * np.tan(last) / np.tan(np.float32(0.5) * (half + last))
    far = 1 / np.cos(last - bend)
    x, y = far * np.cos(bend) - radius * np.cos(last), radius * np.sin(last) - far * np.sin(bend)
    end = np.arctan((y + radius * np.sin(half)) / (x + radius * np.cos(half)))
    return end, 1 - np.tan(half - end) / np.tan(half), (x, y), radius


def _reach(angle, x, y, radius):
    """How far the circle around x, y is in the direction `angle`."""
    nearest = np.sin(angle) * y + np.cos(angle) * x
    return nearest + np.sqrt(np.maximum(nearest * nearest + radius * radius - x * x - y * y, 0))


def _along_arc(distance, beyond, tilt, end, roundness):
    """u at a distance from the origin and an angle `beyond` the end of the straight part: what is straight, then eased by a parabola."""
    level = distance * np.cos(tilt)
    spline = (1 - roundness) * end
    eased = level * beyond + np.float32(0.5) * (1 - level) * divided(beyond * beyond, spline)
    return distance * np.sin(tilt) + np.where(beyond < spline, eased, np.float32(0.5) * spline * (level - 1) + beyond)


def _half_width(level, tilt, end, roundness):
    """Of a segment, at a distance of `level` from the origin across its side."""
    return level * np.tan(tilt) + (1 - roundness) * end * np.float32(0.5) * (level + 1) + roundness * end
