"""Where moving things are at the times of rays: all in float64, so that the way there and back loses nothing."""

from dataclasses import dataclass

import numpy as np

from ..constants import EPS32
from ..maths.poses import Keys, axis_and_angle, rotation_matrix
from ..maths.vectors import cross, dot

_SAME = 8 * EPS32
"""Stretches that differ by less than this, relatively, are those of one rigid body whose matrices were float32."""


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """The motion of one thing, from its local frame into render space: p = R (G l + h) + c at K keys.

    rotation  (4, K), R: quaternions, see `maths.poses.Keys`
    stretch   (3, 3, K), G; pivot (3, K), h; place (3, K), c; all in units of render space
    """

    rotation: np.ndarray
    stretch: np.ndarray
    pivot: np.ndarray
    place: np.ndarray

    @classmethod
    def of(cls, keys, local, anchor, frame):
        """Of a thing with world_from_object `keys`, whose local frame is `local` (3, 3) times (p - anchor) times the scale.

        Without `local` it is the stretch at each time, and G is 1 to the bit.
        """
        stretch = np.repeat(np.eye(3)[..., None], keys.place.shape[1], axis=2)
        if local is not None:
            stretch = np.einsum("ijk,jl->ilk", keys.stretch, np.linalg.inv(local))
        pivot = frame.scale * np.einsum("ijk,j->ik", keys.stretch, anchor)
        return cls(keys.rotation, stretch, pivot, frame.points(keys.place))

    @classmethod
    def of_camera(cls, camera, frame):
        """Of a camera: its local frame is render space, as it is at the middle of the shutter, but centred on its position."""
        if not len(camera.motion):
            still = Keys.of(np.repeat(np.eye(4)[None], 2, axis=0))
            return cls(still.rotation, still.stretch, np.zeros((3, 2)), np.repeat(frame.points(camera.position[:, None]), 2, axis=1))
        middle, keys = np.asarray(camera.world_from_camera, np.float64), Keys.of(camera.motion)
        local = np.linalg.inv(middle[:3, :3])
        # The camera's position is for some cameras not the origin of their frame.
        anchor = local @ (camera.position - middle[:3, 3])
        return cls.of(keys, middle[:3, :3], anchor, frame)


def is_constant(stretch):
    """Whether stretches (3, 3, K) are the same at all keys, but for rounding of the matrices that they come from."""
    return bool((np.abs(stretch - stretch[..., :1]) <= _SAME * np.abs(stretch).max(initial=0)).all())


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """The paths of many things in one table with a row for the way from each key to the next, one thing after the other.

    Along a segment R = R_0 (1 + sin K + (1 - cos) K^2), Rodrigues' formula with the cross product matrix K of its axis; so all that
    changes is a sum of few constants, times the sine and cosine of the angle, and the share f of the segment that has passed.

    first, segments  (O,) the first row of each thing, and how many it has
    angle            (R,) of each segment [rad]
    linear, place    (9, R) and (3, R) constants, to go with 1, sin, cos, f, f sin, f cos; None where they are 0
    centre           the same for the origins of the paths
    is_rigid         there are only rotations
    """

    first: np.ndarray
    segments: np.ndarray
    angle: np.ndarray
    linear: tuple
    place: tuple
    centre: tuple
    is_rigid: bool

    @classmethod
    def of(cls, paths):
        """The table of `Path`s."""
        segments = [path.place.shape[1] - 1 for path in paths]
        before, after = (
            Path(*(np.concatenate([getattr(path, name)[..., part] for path in paths], axis=-1) for name in Path.__slots__))
            for part in (slice(None, -1), slice(1, None))
        )
        axis, angle = axis_and_angle(before.rotation, after.rotation)
        zero = np.zeros_like(angle)
        x, y, z = axis
        across = np.stack((np.stack((zero, -z, y)), np.stack((z, zero, -x)), np.stack((-y, x, zero))))
        start = rotation_matrix(before.rotation)
        sine = _product(start, across)
        cosine = -_product(sine, across)
        turns = (start - cosine, sine, cosine)
        grown, moved = after.stretch - before.stretch, after.pivot - before.pivot
        centre = (before.place, None, None, after.place - before.place)
        linear = [_product(turn, g) for g in (before.stretch, grown) for turn in turns]
        place = [_product(turn, h[:, None])[:, 0] for h in (before.pivot, moved) for turn in turns]
        place = [p if c is None else p + c for p, c in zip(place, (*centre, None, None))]
        identity = np.eye(3)[..., None]
        return cls(
            first=np.cumsum([0, *segments[:-1]]),
            segments=np.array(segments),
            angle=angle,
            linear=_needed([c.reshape(9, -1) for c in linear]),
            place=_needed(place),
            centre=centre,
            is_rigid=bool((before.stretch == identity).all() and not grown.any()),
        )

    def centres(self, index, time):
        """Where the origins of the paths of things `index`, an int or (N,), are at `time` (N,): (3, N)."""
        row, f = self._segment(index, time)
        return _sum(self.centre, row, (None, None, None, f))

    def at(self, index, time):
        """The `Pose` of things `index`, an int or (N,), at `time` (N,) in [0, 1)."""
        row, f = self._segment(index, time)
        turn = f * self.angle.take(row)
        sine, cosine = np.sin(turn), np.cos(turn)
        terms = (None, sine, cosine, f, f * sine, f * cosine)
        return Pose(_sum(self.linear, row, terms).reshape(3, 3, -1), _sum(self.place, row, terms), self.is_rigid)

    def _segment(self, index, time):
        """The row of things `index` at `time`, (N,) or (1,) where all have one; and f (N,)."""
        segments = self.segments[index]
        if np.ndim(segments) == 0 and segments == 1:
            return self.first[[index]], time.astype(np.float64)
        f = time.astype(np.float64) * segments
        # A time is below 1, but its product may round to the last key.
        i = np.minimum(f.astype(np.intp), segments - 1)
        return self.first[index] + i, f - i


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """An affine map for each of N lanes, local to render space: linear (3, 3, N) and place (3, N), float64.

    is_rigid  the linear parts are rotations
    """

    linear: np.ndarray
    place: np.ndarray
    is_rigid: bool

    def points(self, p):
        """Local points (3, N) in render space."""
        return _times(self.linear, p) + self.place

    def vectors(self, v):
        """Local vectors (3, N) in render space."""
        return _times(self.linear, v)

    def normals(self, n):
        """Local normals (3, N), unit, in render space, and how much longer than that the cofactors make them (N,)."""
        turned = _times(self._cofactors(), n)
        size = np.sqrt(dot(turned, turned))
        return turned / np.maximum(size, np.finfo(np.float64).tiny), size

    def local_points(self, p):
        """Points (3, N) of render space in the local frame."""
        return self.local_vectors(p - self.place)

    def local_vectors(self, v):
        """Vectors (3, N) of render space in the local frame; where that is stretched they change their length."""
        cofactors = self._cofactors()
        result = v[0] * cofactors[0]
        result += v[1] * cofactors[1]
        result += v[2] * cofactors[2]
        return result if self.is_rigid else result / self.volume()

    def volume(self):
        """By how much volumes grow on the way to render space, (N,)."""
        return dot(self.linear[0], cross(self.linear[1], self.linear[2]))

    def _cofactors(self):
        a, b, c = self.linear
        return self.linear if self.is_rigid else np.stack((cross(b, c), cross(c, a), cross(a, b)))


def _product(a, b):
    return np.einsum("ijk,jlk->ilk", a, b)


def _times(matrix, v):
    return np.stack([dot(row, v) for row in matrix])


def _needed(constants):
    return tuple(c if c.any() else None for c in constants)


def _sum(constants, row, terms):
    """The constants (C, R) of the rows `row`, each times its term (N,), added up: (C, N)."""
    first, *others = constants
    result = np.zeros(()) if first is None else first.take(row, axis=1)
    for constant, term in zip(others, terms[1:]):
        if constant is not None:
            part = constant.take(row, axis=1) * term
            part += result
            result = part
    return result
