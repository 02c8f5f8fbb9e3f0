"""All lights of a world as one light: choose one, sample it, and know the density of having done so."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Columns, columns
from ..constants import LUMINANCE, ONE_MINUS_EPS32, PI
from ..lights.triangle import TriangleLight
from ..maths import discrete

MAX_HITTABLE = 16
"""With more light objects than this, scattered rays do not look for them: each would be tested one by one."""


@dataclass(frozen=True, slots=True)
class Group:
    """Lights of one kind: indices first .. first + count - 1 of all lights."""

    light: type
    k: Columns
    first: int
    count: int


@dataclass(frozen=True, slots=True)
class Hittable:
    """A light object with a size: its kind, its row, the probability of choosing it, and whether the camera sees it."""

    light: type
    k: Columns
    probability: float
    is_visible: bool


@dataclass(frozen=True, slots=True)
class Lights:
    """Every light of a world, chosen in proportion to its power.

    groups         one `Group` per kind
    cdf            (M,) float64 over all lights
    probability    (M,) float32 of choosing each
    visible        the `Hittable` lights that camera rays see
    hittable       the `Hittable` lights that scattered rays meet: all, or none beyond MAX_HITTABLE
    """

    groups: tuple
    cdf: np.ndarray
    probability: np.ndarray
    visible: tuple
    hittable: tuple

    @classmethod
    def of(cls, lamps, triangles, frame, radius):
        """From light values `lamps` and the columns of emissive `triangles`; `radius` [m] is the scene's, for suns."""
        groups, powers = [], []
        lamps = [lamp for lamp in lamps if any(lamp.power())]
        for kind in dict.fromkeys(type(lamp) for lamp in lamps):
            same = [lamp for lamp in lamps if type(lamp) is kind]
            groups.append(Group(kind, columns([lamp.row(frame) for lamp in same]), len(powers), len(same)))
            powers += [_lamp_power(lamp, radius) for lamp in same]
        # In units of the largest, or lights of 1e30 and 1e-30 W would not fit into one sum.
        powers = np.array(powers, np.float64)
        count = triangles.area.size
        if count:
            groups.append(Group(TriangleLight, triangles, powers.size, count))
            area = triangles.area.astype(np.float64) / frame.scale**2
            powers = np.concatenate((powers, 2 * PI * area * (np.array(LUMINANCE) @ triangles.radiance.astype(np.float64))))
        if not powers.any():
            return cls((), np.zeros(0), np.zeros(0, np.float32), (), ())
        cdf = discrete.cumulative(powers)
        probability = discrete.probabilities(cdf).astype(np.float32)
        hittable = _hittable(lamps, groups, probability)
        return cls(
            tuple(groups),
            cdf,
            probability,
            tuple(lamp for lamp in hittable if lamp.is_visible),
            hittable if len(hittable) <= MAX_HITTABLE else (),
        )

    @property
    def is_empty(self):
        """Whether there is nothing to sample."""
        return not self.groups

    def choose(self, u1):
        """Light indices (N,) and their probability (N,)."""
        index = discrete.choose(self.cdf, u1)
        return index, self.probability.take(index)

    def choose_and_stretch(self, u2):
        """As `choose` with u2[0] (N,), which is then stretched from the light's interval to [0, 1): adds u2 (2, N)."""
        index, probability = self.choose(u2[0])
        u2[0] -= np.concatenate(([0], self.cdf[:-1])).astype(np.float32).take(index)
        u2[0] /= probability
        np.clip(u2[0], 0, np.float32(ONE_MINUS_EPS32), out=u2[0])
        return index, probability, u2

    def sample(self, index, p, u2):
        """A point on light `index` (N,), or on the only light (None): see `interfaces.Light.sample`."""
        if len(self.groups) == 1:
            group = self.groups[0]
            return group.light.sample(group.k if index is None or group.count == 1 else group.k.take(index), p, u2)
        wi, E = np.empty_like(p), np.empty_like(p)
        distance, pdf = np.empty_like(p[0]), np.empty_like(p[0])
        for group in self.groups:
            lanes = np.nonzero((index >= group.first) & (index < group.first + group.count))[0]
            k = group.k.take(index[lanes] - group.first)
            sampled = group.light.sample(k, p.take(lanes, axis=1), u2.take(lanes, axis=1))
            wi[:, lanes], distance[lanes], E[:, lanes], pdf[lanes] = sampled
        return wi, distance, E, pdf


def _lamp_power(lamp, radius):
    power = float(np.dot(LUMINANCE, lamp.power()))
    # A sun lights the scene's cross-section.
    return power * radius**2 if lamp.key == "sun" else power


def _hittable(lamps, groups, probability):
    """`Hittable` for each lamp with a size, in the order of the groups."""
    ordered = [lamp for group in groups for lamp in lamps if type(lamp) is group.light]
    return tuple(
        Hittable(group.light, group.k.take([i]), float(probability[group.first + i]), ordered[group.first + i].is_visible)
        for group in groups
        if group.light is not TriangleLight
        for i in range(group.count)
        if ordered[group.first + i].has_extent()
    )
