"""Materials as tables of lobes: every surface point reflects by the sum of its material's lobes."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Columns, columns
from ..constants import LUMINANCE


@dataclass(frozen=True, slots=True)
class Lobe:
    """One lobe of every material: a BSDF plug-in and its parameters, a row per material (black where it has none)."""

    bsdf: type
    k: Columns


@dataclass(frozen=True, slots=True)
class Materials:
    """All materials of a world.

    lobes       one `Lobe` for each BSDF and for each further lobe of the same BSDF that some material has
    thresholds  (lobes - 1, M) float32: a material samples the lobe whose interval of [0, 1) holds u1
    shares      (lobes, M) float32: the probability of each lobe, in proportion to its albedo
    emission    (3, M) float32 [W m^-2 sr^-1]
    """

    lobes: tuple
    thresholds: np.ndarray
    shares: np.ndarray
    emission: np.ndarray

    @classmethod
    def of(cls, materials, bsdfs):
        """Compile `materials`; `bsdfs` are the plug-ins to make room for, wanted or not."""
        slots = [(bsdf, i) for bsdf in bsdfs for i in range(max(1, max(_count(m, bsdf) for m in materials)))]
        lobes, albedos = [], np.zeros((len(slots), len(materials)))
        for slot, (bsdf, i) in enumerate(slots):
            black = bsdf(reflectance=(0.0, 0.0, 0.0))
            chosen = [next(iter([lobe for lobe in m.lobes if type(lobe) is bsdf][i:]), black) for m in materials]
            lobes.append(Lobe(bsdf, columns([lobe.row() for lobe in chosen])))
            albedos[slot] = [np.dot(LUMINANCE, lobe.albedo()) for lobe in chosen]
        total = albedos.sum(axis=0)
        shares = np.where(total > 0, albedos / np.where(total > 0, total, 1), 1 / max(len(slots), 1)).astype(np.float32)
        thresholds = np.cumsum(shares, axis=0, dtype=np.float64)[:-1].astype(np.float32)
        emission = np.array([m.emission for m in materials], np.float32).T.reshape(3, -1)
        return cls(tuple(lobes), thresholds, shares, emission)

    def at(self, material):
        """The `Reflection` of surface points whose materials are `material` (N,)."""
        if self.emission.shape[1] == 1:  # one row broadcasts over all lanes
            return Reflection(tuple(lobe.bsdf for lobe in self.lobes), tuple(lobe.k for lobe in self.lobes), self.thresholds, self.shares)
        several = len(self.lobes) > 1
        return Reflection(
            tuple(lobe.bsdf for lobe in self.lobes),
            tuple(lobe.k.take(material) for lobe in self.lobes),
            self.thresholds.take(material, axis=1) if several else self.thresholds,
            self.shares.take(material, axis=1) if several else self.shares,
        )


def _count(material, bsdf):
    return sum(type(lobe) is bsdf for lobe in material.lobes)


@dataclass(frozen=True, slots=True, eq=False)
class Reflection:
    """The lobes of N surface points: a BSDF again, the sum of them.

    `eval` adds the lobes up; `sample` chooses one by its share; `pdf` is the density of doing both.
    """

    bsdfs: tuple
    k: tuple
    thresholds: np.ndarray
    shares: np.ndarray

    def eval(self, n, wo, wi):
        """f [sr^-1], (3, N), and pdf [sr^-1], (N,), of wi."""
        first, *others = range(len(self.bsdfs))
        f = self.bsdfs[first].eval(self.k[first], n, wo, wi)
        pdf = self.bsdfs[first].pdf(self.k[first], n, wo, wi)
        if others:
            pdf = pdf * self.shares[first]
        for i in others:
            f = f + self.bsdfs[i].eval(self.k[i], n, wo, wi)
            pdf += self.bsdfs[i].pdf(self.k[i], n, wo, wi) * self.shares[i]
        return f, pdf

    def sample(self, n, wo, u1, u2):
        """Directions wi (3, N); u1 (N,) chooses the lobe (None where there is but one), u2 (2, N) the direction."""
        wi = self.bsdfs[0].sample(self.k[0], n, wo, u2)
        for i, threshold in enumerate(self.thresholds, start=1):
            # Later lobes overwrite earlier ones, so the last threshold passed decides.
            lanes = np.nonzero(np.broadcast_to(u1 >= threshold, u2.shape[1:]))[0]
            k = self.k[i] if self._is_shared(self.k[i]) else self.k[i].take(lanes)
            wi[:, lanes] = self.bsdfs[i].sample(k, n.take(lanes, axis=1), wo.take(lanes, axis=1), u2.take(lanes, axis=1))
        return wi

    @staticmethod
    def _is_shared(k):
        return all(column.shape[-1] == 1 for column in vars(k).values())
