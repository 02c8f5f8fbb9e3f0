"""All lights of a world as one light: choose one, sample it, and know the density of having done so."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Columns, columns
from ..constants import LUMINANCE, PI
from ..lights.triangle import TriangleLight
from .light_choice import MOST_CLUSTERS, ByPlace, ByPower, OnlyLight

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
    """A light object with a size: its kind, its row, its index among all lights, and whether the camera sees it."""

    light: type
    k: Columns
    index: int
    is_visible: bool


@dataclass(frozen=True, slots=True)
class Lights:
    """Every light of a world.

    groups    one `Group` per kind, emissive triangles last
    choice    how one of them is chosen, see `light_choice`
    visible   the `Hittable` lights that camera rays see
    hittable  the `Hittable` lights that scattered rays meet: all, or none beyond MAX_HITTABLE
    """

    groups: tuple
    choice: object
    visible: tuple
    hittable: tuple

    @classmethod
    def of(cls, lamps, emitters, frame, radius, has_choice=True):
        """From light values `lamps` and an `Emitters`; `radius` [m] is the scene's, for suns.

        `has_choice` says that there may be more than one light.
        """
        lamps = [lamp for lamp in lamps if any(lamp.power())]
        kinds = dict.fromkeys(type(lamp) for lamp in lamps)
        lamps = [lamp for kind in kinds for lamp in lamps if type(lamp) is kind]
        groups = []
        for kind in kinds:
            rows = [lamp.row(frame) for lamp in lamps if type(lamp) is kind]
            groups.append(Group(kind, columns(rows), sum(g.count for g in groups), len(rows)))
        if emitters.count:
            groups.append(Group(TriangleLight, emitters.k, len(lamps), emitters.count))
        if not groups:
            return cls((), OnlyLight(), (), ())
        hittable = tuple(_hittable(lamps, groups))
        return cls(
            tuple(groups),
            _choice(lamps, emitters, frame, radius) if has_choice else OnlyLight(),
            tuple(lamp for lamp in hittable if lamp.is_visible),
            hittable if len(hittable) <= MAX_HITTABLE else (),
        )

    @property
    def is_empty(self):
        """Whether there is nothing to sample."""
        return not self.groups

    def sample(self, index, p, u2):
        """A point on light `index` (N,), or on the only light (None): see `interfaces.Light.sample`."""
        if len(self.groups) == 1:
            group = self.groups[0]
            return group.light.sample(group.k if index is None or group.count == 1 else group.k.take(index), p, u2)
        wi, E = np.empty_like(p), np.empty_like(p)
        distance, pdf = np.empty_like(p[0]), np.empty_like(p[0])
        for group in self.groups:
            lanes = np.nonzero((index >= group.first) & (index < group.first + group.count))[0]
            if not lanes.size:
                continue
            k = group.k.take(index.take(lanes) - group.first)
            sampled = group.light.sample(k, p.take(lanes, axis=1), u2.take(lanes, axis=1))
            wi[:, lanes], distance[lanes], E[:, lanes], pdf[lanes] = sampled
        return wi, distance, E, pdf


@dataclass(frozen=True, slots=True, eq=False)
class Emitters:
    """The emissive triangles of a world, object by object.

    k        columns of `lights.triangle.TriangleLight`
    objects  (M,) ascending: which object each belongs to
    """

    k: Columns
    objects: np.ndarray

    @property
    def count(self):
        """How many there are."""
        return self.objects.size

    def power(self):
        """Radiant flux of both sides, luminance, in units of render space squared, (M,) float64."""
        return 2 * PI * self.k.area.astype(np.float64) * (np.array(LUMINANCE) @ self.k.radiance.astype(np.float64))

    def clusters(self, power):
        """One cluster for each object, see `ByPlace.of`."""
        k = self.k
        corners = np.stack((k.v0, k.v0 + k.e1, k.v0 + k.e2)).astype(np.float64)
        edges = np.nonzero(np.diff(self.objects, prepend=-1))[0]
        for start, end in zip(edges, [*edges[1:], self.count]):
            low, high = corners[:, :, start:end].min(axis=(0, 2)), corners[:, :, start:end].max(axis=(0, 2))
            radius2 = 0.25 * float(((high - low) ** 2).sum())
            yield {
                "centre": tuple(0.5 * (low + high)),
                "power": power[start:end].sum() / (2 * PI),
                "nearness": 1.0,
                "radius2": radius2,
                "count": end - start,
            }


def _choice(lamps, emitters, frame, radius):
    flux = emitters.power()
    powers = np.concatenate(([_lamp_power(lamp, radius) * frame.scale**2 for lamp in lamps], flux))
    if powers.size == 1:
        return OnlyLight()
    by_power = ByPower.of(powers)
    if not 1 < len(lamps) + len(np.unique(emitters.objects)) <= MOST_CLUSTERS:
        return by_power
    return ByPlace.of(by_power, [*(_lamp_cluster(lamp, frame) for lamp in lamps), *emitters.clusters(flux)])


def _lamp_power(lamp, radius):
    power = float(np.dot(LUMINANCE, lamp.power()))
    # A sun lights the scene's cross-section.
    return power * radius**2 if lamp.key == "sun" else power


def _lamp_cluster(lamp, frame):
    peak = float(np.dot(LUMINANCE, lamp.peak()))
    if lamp.key == "sun":
        return {"centre": (0.0, 0.0, 0.0), "power": peak, "nearness": 0.0, "radius2": 1.0, "count": 1}
    centre = frame.points(np.asarray(lamp.position, np.float64)[:, None])[:, 0]
    return {
        "centre": tuple(centre),
        "power": peak * frame.scale**2,
        "nearness": 1.0,
        "radius2": (lamp.reach() * frame.scale) ** 2,
        "count": 1,
    }


def _hittable(lamps, groups):
    """`Hittable` for each lamp with a size; `lamps` are in the order of `groups`."""
    for group in groups:
        for i in range(group.count) if group.light is not TriangleLight else ():
            lamp = lamps[group.first + i]
            if lamp.has_extent():
                yield Hittable(group.light, group.k.take([i]), group.first + i, lamp.is_visible)
