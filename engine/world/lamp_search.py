"""Which light objects rays run into: a few are all asked, of many only those whose bounding spheres the rays pass."""

from dataclasses import dataclass

import numpy as np

from ..maths.vectors import dot
from .light_tree import Tree

MOST_ASKED = 16
"""Up to so many lamps are asked about every ray."""
SHARP = 1.0
"""Of more lamps only rays of at least this density [sr^-1] look for them: those that surfaces sharper than dull ones send.
What dull surfaces need of lamps, shadow rays bring as well."""
_MARGIN = 2.0**-20
"""What rounding may be wrong by, in units of the distance; and of the radius, times 2^10."""


@dataclass(frozen=True, slots=True)
class Hittable:
    """A light object with a size: its kind, its row, its index among all lights, its bounding sphere, whether the camera sees it.

    And the number of its group, see `lights.Lights`.
    """

    light: type
    k: object
    index: int
    centre: tuple
    radius: float
    is_visible: bool
    group: int


@dataclass(frozen=True, slots=True)
class EachLamp:
    """Few lamps, a tuple of `Hittable`."""

    lamps: tuple

    def along(self, o, d, lanes):
        """For each lamp that rays o, d (3, N) may meet: the lamp, and the `lanes` (M,) of those rays; None: all."""
        for lamp in self.lamps:
            yield lamp, lanes


@dataclass(frozen=True, slots=True, eq=False)
class LampTree:
    """Many lamps: `everywhere` those without a place, such as suns; the others in a `tree` of spheres.

    lamps           the lamps of the tree
    centre, radius  (K, 3), (K,) float32: sphere of each node
    """

    everywhere: EachLamp
    lamps: tuple
    tree: Tree
    centre: np.ndarray
    radius: np.ndarray

    @classmethod
    def of(cls, lamps):
        """From `Hittable` lamps; a radius of inf is one without a place."""
        placed = tuple(lamp for lamp in lamps if lamp.radius < np.inf)
        centre = np.array([lamp.centre for lamp in placed]).reshape(-1, 3)
        tree = Tree.of(centre.T)
        spheres = np.zeros((tree.first.size, 4))
        spheres[:, :3] = [centre[tree.order[a:b]].mean(axis=0) for a, b in zip(tree.first, tree.last)]
        reach = np.array([lamp.radius for lamp in placed])
        for node, (a, b) in enumerate(zip(tree.first, tree.last)):
            own = tree.order[a:b]
            spheres[node, 3] = (np.linalg.norm(centre[own] - spheres[node, :3], axis=1) + reach[own]).max()
        everywhere = EachLamp(tuple(lamp for lamp in lamps if not lamp.radius < np.inf))
        return cls(everywhere, placed, tree, spheres[:, :3].astype(np.float32), spheres[:, 3].astype(np.float32))

    def along(self, o, d, lanes):
        """See `EachLamp.along`."""
        yield from self.everywhere.along(o, d, lanes)
        stack = [(0, np.arange(o.shape[1]) if lanes is None else lanes)]
        while stack:
            node, lanes = stack.pop()
            lanes = lanes[self._passes(node, o.take(lanes, axis=1), d.take(lanes, axis=1))]
            if not lanes.size:
                continue
            left = self.tree.left[node]
            if left >= 0:
                stack += [(left + 1, lanes), (left, lanes)]
                continue
            for place in range(self.tree.first[node], self.tree.last[node]):
                yield self.lamps[self.tree.order[place]], lanes

    def _passes(self, node, o, d):
        """Which rays (N,) pass the sphere of a node, or would within what rounding may be wrong by."""
        to_centre = self.centre[node][:, None] - o
        along = dot(to_centre, d)
        off_axis = to_centre - along * d
        reach = np.abs(along) * np.float32(_MARGIN) + self.radius[node] * np.float32(1 + 2**10 * _MARGIN)
        return (dot(off_axis, off_axis) <= reach * reach) & (along >= -reach)


def search_of(lamps):
    """`EachLamp` or `LampTree`."""
    placed = sum(lamp.radius < np.inf for lamp in lamps)
    return LampTree.of(lamps) if len(lamps) > MOST_ASKED and placed > 0 else EachLamp(lamps)
