"""Hits in double precision: Embree finds triangles in float32, here they are measured again, and found anew where it was wrong.

Embree sees rays rounded to float32. On the triangle that it names t, u and v are computed once more, from the ray as it is
and the corners that Embree has: one geometry, two precisions. Two kinds of answers are no hits, and the search is repeated with
another ray, which differs more each time:

- the triangle lies behind the origin, as its own does when Embree's rounding finds it again: the other ray starts off it, on the side
  that the ray goes to
- the ray passes the triangle by more than rounding explains, as at grazing slivers (Embree's issue 387): the other ray passes it
  farther away, and so finds what is beside it, which in closed meshes is the neighbour

What is found is measured along the true ray. After MOST_TRIES more searches a ray meets nothing, and is counted.
"""

import threading

import numpy as np

from ..arrays import gather
from ..constants import EPS32
from ..errors import SceneWarning
from ..maths.vectors import cross, dot, length
from .accel import Hits

MOST_TRIES = 6
"""Searches for one ray after the first."""
BESIDE_ULPS = 4
"""How far a ray may pass a triangle by, in units of EPS32 times its length plus coordinate plus extent: of true hits at edges 99.9 %
are within 2, of false ones at slivers 90 % beyond 1300 (measured). Half of what rays start off (`interaction.START_ULPS`), so that none
meets what lies beside its own triangle in the same plane."""
LIFT_ULPS = 4
"""How far off a triangle the second search starts, in units of EPS32 times coordinate plus extent."""
FARTHER = 4
"""By how much the other ray differs more from one search to the next."""
SLIVER = 100
"""The square of the longest edge over the area from which Embree's word is not enough for a shadow."""
_AT_ONCE = 2**16


class Lost:
    """How many rays met nothing because Embree named wrong triangles only; threads share it."""

    def __init__(self):
        self.count = 0
        self._lock = threading.Lock()

    def add(self, count):
        """Count more."""
        with self._lock:
            self.count += count

    def since(self, before):
        """A warning of those that there are more than `before`, if any."""
        more = self.count - before
        told = (
            f"{more} rays met only triangles that double precision does not confirm, in {1 + MOST_TRIES} searches, "
            "and passed them all: look for needle-shaped ones"
        )
        return (SceneWarning(told),) if more else ()


class MeasuredAccel:
    """An `Accel` for rays in float64, whose hits are measured again; the rest is as there.

    embree         the `Accel`
    shape, extent  of its triangles, float64, as `Triangles` has them
    lost           counts the rays that met no triangle but wrong ones
    """

    def __init__(self, embree, shape, extent, lost):
        self.embree = embree
        self.lost = lost
        self._shape, self._extent = shape, extent
        self._has_slivers = _has_slivers(shape)

    def closest(self, o, d, limit=None):
        """As `Accel.closest`, for float64; returns `Hits` of float64."""
        hits, wrong, aside = self._look(o, d, o, d, limit)
        for power in range(MOST_TRIES):
            if not wrong.size:
                return hits
            own_o, own_d, own_limit = gather(o, wrong), gather(d, wrong), None if limit is None else gather(limit, wrong)
            lift, turn = FARTHER**power * aside
            found, again, aside = self._look(own_o + lift, own_d + turn, own_o, own_d, own_limit)
            hits.prim[wrong], hits.t[wrong], hits.u[wrong], hits.v[wrong] = found.prim, found.t, found.u, found.v
            wrong = wrong[again]
        hits.prim[wrong] = -1
        hits.t[wrong] = np.inf if limit is None else gather(limit, wrong)
        hits.u[wrong] = hits.v[wrong] = 0
        self.lost.add(wrong.size)
        return hits

    def occluded(self, o, d, limit):
        """As `Accel.occluded`, for float64. Where there are slivers, what is said to be in the way is measured, too."""
        blocked = self.embree.occluded(_rounded(o), _rounded(d), _rounded(limit))
        lanes = np.nonzero(blocked)[0] if self._has_slivers else ()
        if len(lanes):
            rest = gather(limit, lanes)
            hits = self.closest(gather(o, lanes), gather(d, lanes), rest)
            blocked[lanes] = (hits.prim >= 0) & (hits.t < rest)
        return blocked

    def _look(self, start, towards, o, d, limit):
        """The `Hits` of rays o, d (3, N) with the triangles that Embree finds along others, start and towards (3, N); the lanes (W,) of
        those that are none; and by how much (2, 3, W) origins and directions of others had better differ.
        """
        found = self.embree.closest(_rounded(start), _rounded(towards), None if limit is None else _rounded(limit))
        prim = found.prim
        lanes = np.nonzero(prim >= 0)[0]
        is_all = lanes.size == prim.size
        if not is_all:
            o, d, prim = gather(o, lanes), gather(d, lanes), gather(prim, lanes)
        wrong, aside = np.zeros(0, np.intp), np.zeros((2, 3, 0))
        t, u, v = np.zeros((3, 0))
        if prim.size:
            with np.errstate(all="ignore"):
                t, u, v = _measured(gather(self._shape[:9], prim).reshape(3, 3, -1), o, d)
                doubtful = np.nonzero(~((t > 0) & (u >= 0) & (v >= 0) & (u + v <= 1)))[0]
                if doubtful.size:
                    judged = self._judged(*(gather(column, doubtful) for column in (prim, o, d, t, u, v)))
                    (t[doubtful], u[doubtful], v[doubtful]), is_wrong, aside = judged
                    wrong, aside = doubtful[is_wrong], aside[..., is_wrong]
        if is_all:
            return Hits(prim, t, u, v), wrong, aside
        hits = Hits(found.prim, np.full(found.prim.size, np.inf) if limit is None else limit.copy(), *np.zeros((2, found.prim.size)))
        hits.t[lanes], hits.u[lanes], hits.v[lanes] = t, u, v
        return hits, lanes[wrong], aside

    def _judged(self, prim, o, d, t, u, v):
        """What becomes of rays o, d (3, N) that cross the planes of triangles at t, u, v (N,), but not within these and in front of them.

        Returns t, u, v where each comes nearest to its triangle, if only beside an edge; which rays have it behind them, or are too far
        from there to have met it; and `_look`'s advice (2, 3, N) for these.
        """
        first, e1, e2, n = gather(self._shape, prim).reshape(4, 3, -1)
        # Who goes away from a plane does not cross it, however near it is.
        is_behind = ~(t > 0)
        way, least = np.zeros_like(o), np.zeros_like(u)
        outside = ~((u >= 0) & (v >= 0) & (u + v <= 1))
        least[outside] = np.inf
        # Not 1 in the frame of a moving object that is stretched.
        speed = length(d)
        unit = d / speed
        for corner, edge, (u0, v0), (du, dv) in (
            (first, e1, (0, 0), (1, 0)),
            (first, e2, (0, 0), (0, 1)),
            (first + e1, e2 - e1, (1, 0), (-1, 1)),
        ):
            share, along, away = _nearest(corner - o, edge, unit)
            distance = length(away)
            nearer = distance < least
            least, t, way = np.where(nearer, distance, least), np.where(nearer, along / speed, t), np.where(nearer, away, way)
            u, v = np.where(nearer, u0 + du * share, u), np.where(nearer, v0 + dv * share, v)
        extent = gather(self._extent, prim)
        # Embree's rounding is that of the way to the corners.
        close = BESIDE_ULPS * EPS32 * (t * speed + extent + np.abs(first + u * e1 + v * e2).max(axis=0))
        is_behind |= ~(t > 0)
        lift = LIFT_ULPS * EPS32 * (np.abs(o).max(axis=0) + extent)
        # Past what is behind; and else on the side where the origin is, out of the plane in which Embree's answers are none.
        lift = np.copysign(lift, np.where(is_behind, dot(n, d), dot(n, o - first))) * n
        turn = np.where(is_behind, 0, close / (t * least)) * way
        return (t, u, v), is_behind | ~(least <= close), np.stack((lift, turn))


def _rounded(a):
    """`a` as Embree takes it; what it cannot hold is infinite, and meets nothing."""
    with np.errstate(over="ignore"):
        return a.astype(np.float32)


def _measured(triangles, o, d):
    """t, u, v (N,) where rays o, d (3, N) cross the planes of `triangles`, first corner and edges (3, 3, N); changes these.

    From t d - u e1 - v e2 = v0 - o by Cramer's rule.
    """
    way, e1, e2 = triangles
    way -= o
    n, across = _rows_of_cross(e1, e2), _rows_of_cross(way, d)
    share = 1 / dot(n, d)
    return dot(n, way) * share, dot(across, e2) * share, dot(across, e1) * -share


def _rows_of_cross(a, b):
    """The vector product as three (N,), which need not lie together."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _nearest(way, edge, d):
    """The share of an `edge` (3, N), which begins at `way`, that the line along d, unit, comes nearest to; where on the line that is; and
    the way (3, N) from the edge to the line.
    """
    slope, size2 = dot(edge, d), dot(edge, edge)
    # How much of the edge is not along the line; without any, all of it is as near.
    spread = size2 - slope * slope
    share = np.clip(np.where(spread > 0, (slope * dot(way, d) - dot(way, edge)) / spread, 0), 0, 1)
    point = way + share * edge
    t = dot(point, d)
    return share, t, t * d - point


def _has_slivers(shape):
    """Whether any triangle is one, see SLIVER."""
    for start in range(0, shape.shape[1], _AT_ONCE):
        _, e1, e2 = shape[:9, start : start + _AT_ONCE].reshape(3, 3, -1)
        longest2 = np.maximum(np.maximum(dot(e1, e1), dot(e2, e2)), dot(e2 - e1, e2 - e1))
        if (longest2 > 0.5 * SLIVER * length(cross(e1, e2))).any():
            return True
    return False
