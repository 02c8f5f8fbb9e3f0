"""Emissive triangles of objects that move: shadow rays are sent to where they are at their own time."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Columns
from ..constants import EPS32
from ..maths.patches import END_ULPS, lift
from ..maths.vectors import cross, length
from .movers import Movers


@dataclass(frozen=True, slots=True, eq=False)
class MovingLamps:
    """M triangles that emit, object by object.

    corners        (3, 3, F) float32: corner, coordinate; of all faces of all objects in their local frames, once for each step
    first, stride  (M,) intp: which face a lamp is at the first step, and how much further it is at each of the next
    steps          (M,) how many steps there are
    mover          (M,) intp, the object; owner (M,) its place in the scene
    radiance       (3, M) float32, 1 for those with a texture
    mean           (3, M) their radiance, on average
    prim           (F,) intp: the triangle of the world that each face is; None where nobody asks
    lamp           (T,) intp: which lamp each moving triangle of the world is, -1 for those that do not emit
    """

    movers: Movers
    corners: np.ndarray
    first: np.ndarray
    stride: np.ndarray
    steps: np.ndarray
    mover: np.ndarray
    owner: np.ndarray
    radiance: np.ndarray
    mean: np.ndarray
    prim: object
    lamp: np.ndarray

    @classmethod
    def of(cls, movers, moving, corners, radiance, shine, kept, is_located):
        """Of the objects `moving`, a list of `movers.Moving`.

        corners (3 coordinates, 3, F), radiance (3, F) and `shine` (3, F), see `Emitters.of`, are those of all their faces, part
        after part; kept (T,) which of them are the moving triangles of the world. `is_located` asks for `prim`.
        """
        emits = radiance.any(axis=0)
        lamp = np.full(emits.size, -1)
        first, stride, steps, mover = [], [], [], []
        start = count = 0
        for number, m in enumerate(moving):
            faces = m.parts[0].owner.size
            # What emits is the same at all steps.
            shining = np.nonzero(emits[start : start + faces])[0]
            for values, value in ((first, start + shining), (stride, faces), (steps, len(m.parts)), (mover, number)):
                values.append(np.broadcast_to(value, shining.shape))
            for step in range(len(m.parts)):
                lamp[start + step * faces + shining] = count + np.arange(shining.size)
            count += shining.size
            start += faces * len(m.parts)
        first, stride, steps, mover = map(np.concatenate, (first, stride, steps, mover))
        owner = np.array([m.parts[0].owner[0] for m in moving]).take(mover)
        corners = np.ascontiguousarray(corners.transpose(1, 0, 2))
        # A face that is not kept has no area: whatever it shows is multiplied by 0. There may be no other one that moves.
        prim = np.zeros(emits.size, np.intp)
        prim[kept] = movers.first + np.arange(kept.size)
        colours = (colour.take(first, axis=1) for colour in (shine, radiance))
        return cls(movers, corners, first, stride, steps, mover, owner, *colours, prim if is_located else None, lamp.take(kept))

    @property
    def count(self):
        """How many there are."""
        return self.mover.size

    def at(self, lamp, time):
        """The columns of `maths.patches` of the lamps `lamp` (N,) at `time` (N,), render space."""
        step = (time * self.steps.take(lamp)).astype(np.intp)
        face = self.first.take(lamp) + step * self.stride.take(lamp)
        local = self.corners.take(face, axis=2)
        pose = self.movers.poses.at(self.mover.take(lamp), time)
        v0, v1, v2 = (pose.points(corner).astype(np.float32) for corner in local)
        e1, e2 = v1 - v0, v2 - v0
        normal = cross(e1.astype(np.float64), e2.astype(np.float64))
        double_area = length(normal)
        return Columns(
            v0=v0,
            e1=e1,
            e2=e2,
            normal=(normal / np.maximum(double_area, np.finfo(np.float64).tiny)).astype(np.float32),
            # Rays that end there are rounded in the local frame as well.
            lift=lift(v0, e1, e2) + np.float32(END_ULPS * EPS32) * np.abs(local).max(axis=(0, 1)),
            area=(0.5 * double_area).astype(np.float32),
            radiance=self.radiance.take(lamp, axis=1),
            **({} if self.prim is None else {"prim": self.prim.take(face)}),
        )
