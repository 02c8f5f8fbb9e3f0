"""What rays of each kind see, where objects are hidden from some: a tree for each different set of triangles.

Nothing that is hidden is ever met, so it costs no time; what it costs is the memory of the trees.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..scene.visibility import RAY_KINDS
from .accel import Accel
from .movers import Movers

SHADOW = RAY_KINDS.index("shadow")


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """A set of triangles.

    accel   those that stand still
    prims   (F,) int32 their numbers in the world; None: those of the tree
    movers  the others; None: all stand still
    """

    accel: Accel
    prims: np.ndarray | None
    movers: Movers | None

    def closest(self, o, d, limit, time):
        """`Hits` of rays o, d (3, N) at `time` (N,), in numbers of the world."""
        hits = self.accel.closest(o, d, limit)
        if self.prims is not None:
            met = np.nonzero(hits.prim >= 0)[0]
            hits.prim[met] = self.prims.take(hits.prim.take(met))
        return self.movers.meet(hits, o, d, time) if self.movers else hits

    def occluded(self, o, d, limit, time):
        """Whether any triangle lies within `limit` (N,) along o, d (3, N): (N,) bool."""
        blocked = self.accel.occluded(o, d, limit)
        return self.movers.block(blocked, o, d, limit, time) if self.movers else blocked


@dataclass(frozen=True, slots=True, eq=False)
class Sights:
    """What each of `RAY_KINDS` sees.

    sights   the different `Sight`s
    of_kind  (5,) which of them rays of each kind have
    lit      (5, L + 1) float32: 1 where the light of each of `world.lights` gets to them, else 0; the last is an even world
    """

    sights: tuple
    of_kind: np.ndarray
    lit: np.ndarray | None = None

    @classmethod
    def of(cls, scene, owner, mesh, whole, moving, measured):
        """From a `scene`, but for its lights.

        owner   (F,) the object of each triangle that stands still
        mesh    their vertices (3, V) and corners (3, F)
        whole   the `Sight` of those who see everything
        moving  the numbers of the objects that move, in the order of `whole.movers`
        measured  makes trees of `Accel`s and which of all triangles they are of
        """
        vertices, corners = mesh
        moving = np.array(moving, np.intp)
        known, of_kind = {}, []
        for kind in RAY_KINDS:
            seen = np.array([kind not in o.hidden_from for o in scene.objects], bool)
            if seen.tobytes() not in known:
                sight = whole
                if not seen.all():
                    prims = np.nonzero(seen.take(owner))[0]
                    movers = whole.movers and whole.movers.only(np.nonzero(seen.take(moving))[0])
                    accel = measured(Accel(vertices, corners.take(prims, axis=1)), prims)
                    sight = Sight(accel, prims.astype(np.int32), movers)
                known[seen.tobytes()] = len(known), sight
            of_kind.append(known[seen.tobytes()][0])
        return cls(tuple(sight for _, sight in known.values()), np.array(of_kind))

    def of_lights(self, scene, lights, objects):
        """The same with the `Lights` of the world; `objects` (M,) are the places of those that its emissive patches belong to."""
        world = scene.world.hidden_from
        hidden = [*lights.hidden_from, *([world] if lights.environment else ()), *(scene.objects[o].hidden_from for o in objects), world]
        return replace(self, lit=np.array([[kind not in own for own in hidden] for kind in RAY_KINDS], np.float32))

    @property
    def hides_lights(self):
        """Whether the light of any does not get to some rays."""
        return not self.lit.all()
