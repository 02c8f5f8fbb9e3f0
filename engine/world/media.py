"""Which medium is behind each triangle, and which is there where bodies overlap."""

from dataclasses import dataclass

import numpy as np

from ..interfaces import albedo_of
from ..scene.bodies import inside_of, sharing_space, volume
from ..scene.medium import Medium
from ..scene.textured import averaged


@dataclass(frozen=True, slots=True, eq=False)
class Media:
    """The M media of a world in the order of their rank, the strongest first; after them, row M, the vacuum.

    Where a point is in several bodies the strongest medium is the one that is there: that of the highest priority, of equal
    ones that of the smaller body, so that what is inside of another is there.

    absorption  (3, M + 1) float32, per unit of render space
    absorbs     (M + 1,) bool: whether it does
    ior         (M + 1,) float32 index of refraction
    spread      (M + 1,) float32: how much more it is at Fraunhofer's line F than at C
    behind      (F,) intp: the medium behind each triangle, -1 where there is none; (1,) where no triangle is left
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
    def of(cls, bodies, row, material, owner, scale):
        """The media of `bodies`; `row` numbers the materials, `material` and `owner` (F,) belong to the triangles.

        `scale` [m^-1] is that of render space.
        """
        is_open = np.zeros(len(row), bool)
        is_open[[row[m] for materials in bodies.ranked for m in materials]] = True
        media = [materials[0].medium or Medium() for materials in bodies.ranked]
        absorption = np.array([medium.absorption for medium in media] + [(0, 0, 0)], np.float64).T / scale
        ior, spread = np.array([*map(_index, bodies.ranked), (1, 0)], np.float64).T
        return cls(
            absorption=absorption.astype(np.float32),
            absorbs=absorption.any(axis=0),
            ior=ior.astype(np.float32),
            spread=spread.astype(np.float32),
            # Rays that meet nothing look it up too.
            behind=np.where(is_open.take(material), bodies.rank.take(owner), -1) if material.size else np.full(1, -1),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """The objects of a scene that light gets into; those that wear the same materials have the same medium.

    ranked  the materials of each medium, the strongest first
    rank    (objects,) intp: the medium of each object, -1 where it has none
    layer   (objects,) intp: how strong it is, 1 for the weakest; 0 for objects that share no space with another body
    """

    ranked: tuple
    rank: np.ndarray
    layer: np.ndarray

    @classmethod
    def of(cls, objects):
        """The bodies among `objects`."""
        largest, worn, volumes = {}, [inside_of(o) for o in objects], {}
        for o, materials in zip(objects, worn):
            if materials:
                if id(o.mesh) not in volumes:
                    volumes[id(o.mesh)] = volume(o.mesh)
                size = volumes[id(o.mesh)] * abs(np.linalg.det(o.world_from_object[:3, :3]))
                largest[materials] = max(largest.get(materials, 0.0), size)
        ranked = sorted(largest, key=lambda materials: (-(materials[0].medium or Medium()).priority, largest[materials]))
        place = {materials: i for i, materials in enumerate(ranked)} | {(): -1}
        rank = np.array([place[materials] for materials in worn] or [-1], np.intp)
        sharing = {id(o) for o in sharing_space([o for o, materials in zip(objects, worn) if materials])}
        return cls(tuple(ranked), rank, np.array([len(ranked) - i if id(o) in sharing else 0 for o, i in zip(objects, rank)] or [0]))


def _index(materials):
    """Index of refraction and spread of what is inside: those of the first surface that has them."""
    seen = (lobe for m in materials for lobe in map(averaged, m.lobes) if hasattr(lobe, "ior") and any(albedo_of(lobe)))
    return next(((lobe.ior, getattr(lobe, "spread", 0)) for lobe in seen), (1, 0))
