"""All lights of a world as one light: choose one, sample it, and know the density of having done so."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Columns, columns, gather
from ..constants import LUMINANCE
from ..lights.parallelogram import ParallelogramLight
from ..lights.triangle import TriangleLight
from .lamp_search import MOST_ASKED, SHARP, Hittable, search_of
from .light_choice import ByPlace, OnlyLight
from .light_tree_choice import ByTree
from .shades import ShadedGlow, share_left
from .texturing import EVEN

LEAST = 2.0**-10
"""The smallest share of its light by which a shaded light is chosen: what is dark where it was looked at may shine elsewhere."""
MOST_WEIGHED = 32
"""Up to so many lights are all weighed against each other at every point; of more, groups are."""


@dataclass(frozen=True, slots=True)
class Group:
    """Lights of one kind: indices first .. first + count - 1 of all lights.

    glow    what textured patches shine with, see `texturing`, and what lights do through textures, see `shades`
    """

    light: type
    k: Columns
    first: int
    count: int
    glow: object = EVEN

    def sample(self, row, p, u2, time):
        """A point on the lights `row` (N,) of the group at `time` (N,), or on its only light (None): see `interfaces.Light.sample`."""
        return self._sample(self._rows(row, time), p, u2)

    def sample_middle(self, row, p, u2, time):
        """The same for the middle of the lights; u2 (2, N) counts for those that have none."""
        k = self._rows(row, time)
        middle = getattr(self.light, "middle", None)
        return self._sample(k, p, np.broadcast_to(middle(k), u2.shape) if middle else u2)

    def _sample(self, k, p, u2):
        wi, distance, E, pdf = self.light.sample(k, p, u2)
        return wi, distance, self.glow.lit(E, k, p, wi, distance), pdf

    def _rows(self, row, time):
        return self.k if row is None or self.count == 1 else self.k.take(row)


class MovingGroup(Group):
    """Lights that move; `k` are the `MovingLamps`."""

    def _rows(self, row, time):
        return self.k.at(np.broadcast_to(0 if row is None else row, time.shape), time)


@dataclass(frozen=True, slots=True)
class Lights:
    """Every light of a world.

    groups       one `Group` per kind, the environment after the lamps, emissive patches last
    environment  the `Environment`, the light before the first patch; or None
    first_patch  the index of the first emissive patch
    choice       how one of them is chosen, see `light_choice`
    visible      the lamps that camera rays see, to be searched by `lamp_search`
    hittable     the lamps that scattered rays meet: all that have a size
    hidden_from  the kinds of rays that each lamp is hidden from
    dark         the names of lights whose shades seem to leave nothing
    lamp_groups  the light groups of the lamps, in their order
    few_sharp    rays of a density below SHARP do not look for lamps, the first `lamps` of all lights
    """

    groups: tuple
    environment: object
    first_patch: int
    choice: object
    visible: object
    hittable: object
    few_sharp: bool = False
    lamps: int = 0
    dark: tuple = ()
    lamp_groups: tuple = ()
    hidden_from: tuple = ()

    @classmethod
    def of(cls, lamps, environment, emitters, frame, radius, has_choice=True, are_sampled=True, glow=EVEN, camera=None, real=np.float32):
        """From light values `lamps`, an `Environment` or None, and `Emitters`; `radius` [m] is the scene's, for what is distant.

        `has_choice` says that there may be more than one light, `are_sampled` that shadow rays look for them;
        `glow` is that of the emitters; `camera` is the `CameraSpace`, for lights with a shade; the others have columns of the dtype `real`.
        """
        lamps = [lamp for lamp in lamps if any(lamp.power())]
        kinds = {}
        for lamp in lamps:
            kinds.setdefault((type(lamp), lamp.shade is not None), []).append(lamp)
        groups = []
        for (kind, is_shaded), own in kinds.items():
            k, shine = ShadedGlow.of(own, frame, camera) if is_shaded else (columns([lamp.row(frame) for lamp in own], real), EVEN)
            groups.append(Group(kind, k, sum(g.count for g in groups), len(own), shine))
        lamps = [lamp for own in kinds.values() for lamp in own]
        shares = [share_left(lamp, frame, camera, radius) if lamp.shade else np.ones(3) for lamp in lamps]
        if environment:
            groups.append(Group(type(environment), environment, len(lamps), 1))
        first_patch = sum(group.count for group in groups)
        split = emitters.parallelograms
        for kind, patches in ((ParallelogramLight, slice(0, split)), (TriangleLight, slice(split, emitters.still))):
            if patches.stop > patches.start:
                groups.append(Group(kind, emitters.k.part(patches), first_patch + patches.start, patches.stop - patches.start, glow))
        if emitters.moving:
            groups.append(MovingGroup(TriangleLight, emitters.moving, first_patch + emitters.still, emitters.moving.count, glow))
        if not groups:
            return cls((), None, 0, OnlyLight(), search_of(()), search_of(()))
        hittable = tuple(_hittable(lamps, groups, frame))
        return cls(
            tuple(groups),
            environment,
            first_patch,
            _choice(lamps, shares, environment, emitters, frame, radius) if has_choice else OnlyLight(),
            search_of(tuple(lamp for lamp in hittable if lamp.is_visible)),
            search_of(hittable),
            are_sampled and len(hittable) > MOST_ASKED,
            len(lamps),
            tuple(lamp.name for lamp, share in zip(lamps, shares) if not share.any()),
            tuple(lamp.group for lamp in lamps),
            tuple(lamp.hidden_from for lamp in lamps),
        )

    def seen_from(self, camera):
        """The same lights, whose textures know of another camera, a `CameraSpace`."""
        return replace(self, groups=tuple(replace(group, glow=group.glow.seen_from(camera)) for group in self.groups))

    @property
    def is_empty(self):
        """Whether there is nothing to sample."""
        return not self.groups

    def chance(self, index, rays, lanes):
        """The probability (M,) with which shadow rays from where `rays` came from are sent to lights `index` (M,), for `lanes` (M,)."""
        facing = rays.facing
        return self.choice.probability(index, gather(rays.o, lanes), facing if facing is None else gather(facing, lanes))

    def rival(self, index, pdf):
        """The density with which scattered rays look for lights `index`, where they are sent with the density `pdf` (N,)."""
        return np.where((index < self.lamps) & (pdf < SHARP), np.float32(0), pdf) if self.few_sharp else pdf

    def looks_for_lamps(self, pdf):
        """Which scattered rays (M,) of density `pdf` (N,) do; None: all."""
        return np.nonzero(pdf >= SHARP)[0] if self.few_sharp else None

    def sample(self, index, p, u2, time=None):
        """A point on light `index` (N,), or on the only light (None), at `time` (N,): see `interfaces.Light.sample`.

        Where nothing moves the time is None.
        """
        return self._of_groups(Group.sample, index, p, u2, time)

    def sample_middle(self, index, p, u2, time=None):
        """The same for the middle of light `index`, (N,) or an integer."""
        if not isinstance(index, int):
            return self._of_groups(Group.sample_middle, index, p, u2, time)
        group = next(group for group in self.groups if index < group.first + group.count)
        return group.sample_middle(np.array([index - group.first]), p, u2, time)

    @property
    def count(self):
        """How many lights there are."""
        return sum(group.count for group in self.groups)

    @property
    def have_middles(self):
        """Whether every light can be shrunk to its middle."""
        return all(hasattr(group.light, "middle") for group in self.groups)

    def _of_groups(self, sample, index, p, u2, time):
        if len(self.groups) == 1:
            return sample(self.groups[0], index, p, u2, time)
        wi, E = np.empty_like(p), np.empty_like(p)
        distance, pdf = np.empty_like(p[0]), np.empty_like(p[0])
        for group in self.groups:
            lanes = np.nonzero((index >= group.first) & (index < group.first + group.count))[0]
            if not lanes.size:
                continue
            row, when = gather(index, lanes) - group.first, None if time is None else gather(time, lanes)
            sampled = sample(group, row, gather(p, lanes), gather(u2, lanes), when)
            wi[:, lanes], distance[lanes], E[:, lanes], pdf[lanes] = sampled
        return wi, distance, E, pdf


def _choice(lamps, shares, environment, emitters, frame, radius):
    """How one of all lights is chosen; `shares` (3,) are what shades leave of the lamps, `radius` [m] is the scene's."""
    lights = [*lamps, environment] if environment else lamps
    if len(lights) + emitters.count == 1:
        return OnlyLight()
    shares = [*(np.maximum(share, LEAST) for share in shares), 1.0]
    rows = [light.weight(frame) for light in lights]
    rows = [row | {"power": np.multiply(row["power"], share)} for row, share in zip(rows, shares)]
    weights = emitters.weights()
    if rows:
        of_lamps = vars(columns([row | {"power": np.dot(LUMINANCE, row["power"])} for row in rows], np.float64))
        weights = Columns(**{name: np.concatenate((of_lamps[name], column), axis=-1) for name, column in vars(weights).items()})
    if weights.power.size <= MOST_WEIGHED:
        return ByPlace.of(weights)
    powers = [frame.scale**2 * np.dot(LUMINANCE, np.multiply(light.power(radius), share)) for light, share in zip(lights, shares)]
    return ByTree.of(np.concatenate((powers, emitters.power())), weights)


def _hittable(lamps, groups, frame):
    """`Hittable` for each lamp with a size; `lamps` are in the order of `groups`."""
    for number, group in enumerate(groups):
        for i, lamp in enumerate(lamps[group.first : group.first + group.count]):
            if lamp.has_extent():
                weight = lamp.weight(frame)
                radius = math.sqrt(weight["radius2"]) if weight["nearness"] else math.inf
                yield Hittable(group.light, group.k.take([i]), group.first + i, weight["centre"], radius, lamp.is_visible, number)
