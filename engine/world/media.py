"""Which medium is behind each triangle, and which is there where bodies overlap."""

from dataclasses import dataclass

import numpy as np

from ..scene.bodies import inside_of, volume
from ..scene.medium import Medium


@dataclass(frozen=True, slots=True, eq=False)
class Media:
    """The M media of a world in the order of their rank, the strongest first; after them, row M, the vacuum.

    Where a point is in several bodies the strongest medium is the one that is there: that of the highest priority, of equal
    ones that of the smaller body, so that what is inside of another is there.

    absorption  (3, M + 1) float32, per unit of render space
    absorbs     (M + 1,) bool: whether it does
    ior         (M + 1,) float32 index of refraction
    spread      (M + 1,) float32: how much more it is at Fraunhofer's line F than at C
    behind      (F,) intp: the medium behind each triangle, -1 where there is none
    """

    absorption: np.ndarray
    absorbs: np.ndarray
    ior: np.ndarray
    spread: np.ndarray
    behind: np.ndarray

    @property
    def count(self):
        """How many media there are besides the vacuum."""
        return self.ior.size - 1

    @classmethod
    def of(cls, objects, row, material, owner, scale):
        """The media inside `objects`; `row` numbers the materials, `material` and `owner` (F,) belong to the triangles.

        Objects that wear the same materials have the same medium. `scale` [m^-1] is that of render space.
        """
        largest, worn, volumes = {}, [inside_of(o) for o in objects], {}
        for o, materials in zip(objects, worn):
            if materials:
                if id(o.mesh) not in volumes:
                    volumes[id(o.mesh)] = volume(o.mesh)
                size = volumes[id(o.mesh)] * abs(np.linalg.det(o.world_from_object[:3, :3]))
                largest[materials] = max(largest.get(materials, 0.0), size)
        media = {materials: materials[0].medium or Medium() for materials in largest}
        ranked = sorted(largest, key=lambda materials: (-media[materials].priority, largest[materials]))
        rank = {materials: i for i, materials in enumerate(ranked)} | {(): -1}
        is_open = np.zeros(len(row), bool)
        is_open[[row[m] for materials in ranked for m in materials]] = True
        behind = np.array([rank[materials] for materials in worn] or [-1], np.intp).take(owner)
        absorption = np.array([media[materials].absorption for materials in ranked] + [(0, 0, 0)], np.float64).T / scale
        ior, spread = np.array([*map(_index, ranked), (1, 0)], np.float64).T
        return cls(
            absorption=absorption.astype(np.float32),
            absorbs=absorption.any(axis=0),
            ior=ior.astype(np.float32),
            spread=spread.astype(np.float32),
            behind=np.where(is_open.take(material), behind, -1),
        )


def _index(materials):
    """Index of refraction and spread of what is inside: those of the first surface that has them."""
    return next(((lobe.ior, lobe.spread) for m in materials for lobe in m.lobes if hasattr(lobe, "ior") and any(lobe.albedo())), (1, 0))
