"""Objects that move: rays are carried into each one's own frame at their own time, and met there by its own tree.

A rigid object needs one tree, and its motion is continuous: there are no slices of time. A mesh that deforms has one
tree for each of a number of steps, each with the shape of the middle of its share of the shutter; it is still carried
along continuously by its object.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..constants import EPS32
from ..maths.poses import Keys
from ..maths.vectors import dot, length
from ..scene.motion import no_motion
from .accel import Accel
from .placement import place
from .poses import Path, Poses, is_constant

_SLACK = 16 * EPS32
"""Of the squared distance between a ray's origin and an object: what the rounding of the ray's direction does to it."""


@dataclass(frozen=True, slots=True, eq=False)
class Moving:
    """A moving object before render space is known.

    parts   a `placement.Part` for each step, in metres of the object's local frame
    world   (3, V) its vertices at the middle of the shutter
    keys    its `Keys`, and the `anchor` (3,) of its mesh that is the origin of the local frame
    local   (3, 3) the stretch of the local frame; None where each step has its own, or it does not change
    """

    parts: tuple
    world: np.ndarray
    keys: Keys
    anchor: np.ndarray
    local: object

    @classmethod
    def of(cls, number, o, row, smooth, steps):
        """The object `o`, `number` of the scene, with `steps` trees where one is not enough; see `placement.place`."""
        keys = Keys.of(o.motion if o.moves else np.repeat(o.world_from_object[None], 2, axis=0))
        is_stretched = not is_constant(keys.stretch)
        # Space that is flattened on the way has no inverse: such a stretch is a deformation.
        sides = np.linalg.det(np.moveaxis(keys.stretch, -1, 0))
        deforms = o.mesh.deforms or (is_stretched and not ((sides > 0).all() or (sides < 0).all()))
        count = steps if deforms else 1
        vertices = o.mesh.vertices.astype(np.float64)
        anchor = 0.5 * (vertices.min(axis=1) + vertices.max(axis=1))
        parts = []
        for time in (np.arange(count) + 0.5) / count:
            matrix = np.eye(4)
            matrix[:3, :3] = keys.stretch_at(time)
            matrix[:3, 3] = -matrix[:3, :3] @ anchor
            still = replace(o, mesh=o.mesh.at(time), world_from_object=matrix, motion=no_motion())
            # Textures stick to the mesh: they are looked up where its corners are at rest.
            parts += [replace(part, mesh=o.mesh) for part in place([(number, still)], row, smooth)]
        world = o.world_from_object[:3, :3] @ vertices + o.world_from_object[:3, 3:]
        return cls(tuple(parts), world, keys, anchor, keys.stretch_at(0.5) if is_stretched and not deforms else None)


@dataclass(frozen=True, slots=True, eq=False)
class Movers:
    """All moving objects of a world.

    first  the first of their triangles, which are the last of the world; `owner` (M,) intp which object each is of
    poses  where they are, see `Poses`
    reach  (O,) how far their triangles are from the origins of their paths at most
    trees  for each object, for each of its steps: (Accel, the number of its first triangle)
    """

    first: int
    owner: np.ndarray
    poses: Poses
    reach: np.ndarray
    trees: tuple

    @classmethod
    def of(cls, moving, frame, vertices, triangles, first):
        """From `Moving` objects, local vertices (3, V) float32 and triangles of each part, and the number of the first triangle."""
        trees, owner, reach, paths = [], [], [], []
        parts = iter(zip(vertices, triangles, strict=True))
        start = first
        for number, m in enumerate(moving):
            steps, farthest = [], 0.0
            for _ in m.parts:
                corners, indices = next(parts)
                steps.append((Accel(corners, indices), start))
                start += indices.shape[1]
                farthest = max(farthest, length(corners.astype(np.float64)).max(initial=0))
            path = Path.of(m.keys, m.local, m.anchor, frame)
            # Between keys no stretch and no pivot is larger than at one of them.
            gain = np.linalg.norm(np.moveaxis(path.stretch, -1, 0), 2, axis=(1, 2)).max()
            reach.append((gain * farthest + length(path.pivot).max()) * (1 + _SLACK))
            owner.append(np.full(start - steps[0][1], number))
            trees.append(tuple(steps))
            paths.append(path)
        return cls(first, np.concatenate(owner), Poses.of(paths), np.array(reach), tuple(trees))

    def meet(self, hits, o, d, time):
        """`hits` of rays o, d (3, N) at `time` (N,), changed where a moving triangle is nearer."""
        for accel, first, lanes, near_o, near_d in self._near(o, d, time, hits.t):
            found = accel.closest(near_o, near_d, hits.t.take(lanes))
            met = np.nonzero(found.prim >= 0)[0]
            into = lanes.take(met)
            hits.prim[into] = found.prim.take(met) + first
            for ours, theirs in ((hits.t, found.t), (hits.u, found.u), (hits.v, found.v)):
                ours[into] = theirs.take(met)
        return hits

    def block(self, blocked, o, d, limit, time):
        """`blocked` (N,) of rays o, d (3, N) with `limit` (N,), changed where a moving triangle is in the way."""
        limit = np.where(blocked, np.float32(-1), limit)
        for accel, _, lanes, near_o, near_d in self._near(o, d, time, limit):
            blocked[lanes] |= accel.occluded(near_o, near_d, limit.take(lanes))
        return blocked

    def _near(self, o, d, time, limit):
        """Each tree with the lanes of the rays that may meet it, and those rays in its frame."""
        for number, steps in enumerate(self.trees):
            lanes = self._passing(number, o, d, time, limit)
            if not lanes.size:
                continue
            when = time.take(lanes)
            pose = self.poses.at(number, when)
            near_o = pose.local_points(o.take(lanes, axis=1)).astype(np.float32)
            near_d = pose.local_vectors(d.take(lanes, axis=1)).astype(np.float32)
            if len(steps) == 1:
                yield *steps[0], lanes, near_o, near_d
                continue
            step = (when * len(steps)).astype(np.intp)
            for i, tree in enumerate(steps):
                part = np.nonzero(step == i)[0]
                if part.size:
                    yield *tree, lanes.take(part), near_o.take(part, axis=1), near_d.take(part, axis=1)

    def _passing(self, number, o, d, time, limit):
        """The lanes of the rays that come near object `number`: within its reach of where it is at their time."""
        away = self.poses.centres(number, time) - o
        along = dot(away, d)
        distance2 = dot(away, away)
        reach = self.reach[number]
        passes = distance2 * (1 - _SLACK) - along * along <= reach * reach
        passes &= (along >= 0) | (distance2 * (1 - _SLACK) <= reach * reach)
        return np.nonzero(passes & (along * (1 - _SLACK) - reach <= limit))[0]
