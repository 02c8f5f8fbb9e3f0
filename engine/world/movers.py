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
_MOST_IN_LEAF = 8
"""So many objects are looked at one by one; more are looked for in halves."""


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
        # Vertices that are nowhere cost their triangles, not all the others.
        somewhere = vertices[:, np.isfinite(vertices).all(axis=0)]
        anchor = 0.5 * (somewhere.min(axis=1) + somewhere.max(axis=1)) if somewhere.size else np.zeros(3)
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

    def away(self, origin):
        """How far the origin of the local frame comes from `origin` (3,) at most [m]."""
        pivot = np.einsum("ijk,j->ik", self.keys.stretch, self.anchor)
        return float(length(self.keys.place - origin[:, None]).max() + length(pivot).max())


@dataclass(frozen=True, slots=True, eq=False)
class Movers:
    """All moving objects of a world.

    first  the first of their triangles, which are the last of the world; `owner` (M,) intp which object each is of
    poses  where they are, see `Poses`
    reach  (O,) how far their triangles are from the origins of their paths at most
    trees  for each object, for each of its steps: (an `Accel` or a `MeasuredAccel`, the number of its first triangle)
    bounds a tree of `Node`s around all of them
    spheres around what each sweeps while the shutter is open: centres (3, O), radii (O,)
    """

    first: int
    owner: np.ndarray
    poses: Poses
    reach: np.ndarray
    trees: tuple
    bounds: object
    spheres: tuple

    @classmethod
    def of(cls, moving, frame, vertices, triangles, first, measured):
        """From `Moving` objects, local vertices (3, V) float32 and triangles of each part, and the number of the first triangle.

        `measured` makes trees of `Accel`s and which of all triangles they are of.
        """
        trees, owner, reach, paths = [], [], [], []
        parts = iter(zip(vertices, triangles, strict=True))
        start = first
        for number, m in enumerate(moving):
            steps, farthest = [], 0.0
            for _ in m.parts:
                corners, indices = next(parts)
                steps.append((measured(Accel(corners, indices), slice(start, start + indices.shape[1])), start))
                start += indices.shape[1]
                # Of what is met only: other corners may be anywhere.
                farthest = max(farthest, length(corners.take(indices.ravel(), axis=1).astype(np.float64)).max(initial=0))
            path = Path.of(m.keys, m.local, m.anchor, frame)
            # Between keys no stretch and no pivot is larger than at one of them.
            gain = np.linalg.norm(np.moveaxis(path.stretch, -1, 0), 2, axis=(1, 2)).max()
            reach.append((gain * farthest + length(path.pivot).max()) * (1 + _SLACK))
            owner.append(np.full(start - steps[0][1], number))
            trees.append(tuple(steps))
            paths.append(path)
        reach = np.array(reach)
        sides = [(path.place.min(axis=1), path.place.max(axis=1)) for path in paths]
        centres = np.stack([0.5 * (low + high) for low, high in sides], axis=1)
        swept = reach + np.array([0.5 * np.linalg.norm(high - low) for low, high in sides])
        bounds = Node.around(centres, swept, np.arange(len(paths)))
        return cls(first, np.concatenate(owner), Poses.of(paths), reach, tuple(trees), bounds, (centres, swept))

    def only(self, numbers):
        """The same of which only the objects `numbers` (M,) are ever met; None without any."""
        return replace(self, bounds=Node.around(*self.spheres, numbers)) if numbers.size else None

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
        for number, lanes in self._passing(self.bounds, None, o, d, time, limit):
            steps, when = self.trees[number], time.take(lanes)
            pose = self.poses.at(number, when)
            near_o = pose.local_points(o.take(lanes, axis=1)).astype(o.dtype)
            near_d = pose.local_vectors(d.take(lanes, axis=1)).astype(d.dtype)
            if len(steps) == 1:
                yield *steps[0], lanes, near_o, near_d
                continue
            step = (when * len(steps)).astype(np.intp)
            for i, tree in enumerate(steps):
                part = np.nonzero(step == i)[0]
                if part.size:
                    yield *tree, lanes.take(part), near_o.take(part, axis=1), near_d.take(part, axis=1)

    def _passing(self, node, lanes, o, d, time, limit):
        """Each object of a node of `bounds` with the lanes of the rays that come within its reach of where it is at their time.

        o, d, time are those of the rays `lanes` (None: all); `limit` is that of all, as it is when it is asked for.
        """
        for number in node.objects:
            found = _passes(self.poses.centres(number, time) - o, d, self.reach[number], _picked(limit, lanes))
            if found.size:
                yield number, found if lanes is None else lanes.take(found)
        for child in node.children:
            found = _passes(child.centre - o, d, child.radius, _picked(limit, lanes))
            if found.size:
                inner = found if lanes is None else lanes.take(found)
                yield from self._passing(child, inner, o.take(found, axis=1), d.take(found, axis=1), time.take(found), limit)


@dataclass(frozen=True, slots=True, eq=False)
class Node:
    """A sphere around everything that some objects sweep while the shutter is open: some itself, others by its children.

    centre (3, 1), radius; objects, a tuple of numbers; children, a tuple of nodes
    """

    centre: np.ndarray
    radius: float
    objects: tuple
    children: tuple

    @classmethod
    def around(cls, centres, radii, numbers):
        """A tree around the spheres `centres` (3, O), `radii` (O,) of the objects `numbers` (M,), split where they lie farthest apart."""
        own, sizes = centres[:, numbers], radii[numbers]
        low, high = (own - sizes).min(axis=1), (own + sizes).max(axis=1)
        centre = 0.5 * (low + high)[:, None]
        objects, children = tuple(numbers), ()
        if numbers.size > _MOST_IN_LEAF:
            order = numbers[np.argsort(own[np.argmax(high - low)], kind="stable")]
            objects, children = (), tuple(cls.around(centres, radii, half) for half in np.array_split(order, 2))
        return cls(centre, float((length(own - centre) + sizes).max() * (1 + _SLACK)), objects, children)


def _passes(away, d, radius, limit):
    """The lanes of rays along d (3, N) that come within `radius` of what is `away` (3, N) from their origins, before their limit."""
    along = dot(away, d)
    distance2 = dot(away, away)
    distance2 *= 1 - _SLACK
    passes = distance2 - along * along <= radius * radius
    passes &= (along >= 0) | (distance2 <= radius * radius)
    passes &= along * (1 - _SLACK) - radius <= limit
    return np.nonzero(passes)[0]


def _picked(limit, lanes):
    return limit if lanes is None else limit.take(lanes)
