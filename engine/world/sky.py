"""A texture of all directions around a scene as a light: worked out where rays escape, and sampled in proportion to a picture of it."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np

from ..constants import LUMINANCE, ONE_MINUS_EPS32
from ..maths.equirect import direction_to_square, square_to_direction
from ..maths.frames import to_world
from ..maths.vectors import dot
from ..maths.warps import square_to_cone, square_to_cone_pdf
from ..scene.coordinates import Coordinates
from ..scene.environment import EnvironmentMap
from ..scene.graphs import is_texture, with_inner
from ..scene.points import OnPlane
from .environment import Environment
from .texturing import clean

SHAPE = (256, 512)
"""Rows and columns of the picture by which directions are chosen; what it misses is found by scattered rays."""
_PLACES = ("generated", "object", "position", "camera")
_FLOOR = 2.0**-6
"""Every direction is chosen at least so often, compared to the mean."""
_MOST = 0.75
"""The largest share of shadow rays that look for disks, as these may be hidden."""
_ROUNDING = 2.0**-10
"""What single precision may leave of directions within a disk, and of turns."""
_GRID = 16
"""Rows and columns of places at which the light of a disk is measured."""


class Directions(OnPlane):
    """Points infinitely far away in the directions d (3, N), which face the viewer: what the texture of a world is handed as `at`."""

    d = None

    def __init__(self, d, is_seen=False):
        super().__init__(d)
        self.d, self._is_seen = d, is_seen

    def attribute(self, key):
        """All places of a direction are the direction; there is no mesh and no object, whose attributes are 0."""
        found, *along = super().attribute(key)
        if key[0] in _PLACES:
            found = self.d
        elif not key[0].endswith(("_object", "_world")):
            found = np.zeros_like(found)
        return found, *along

    @property
    def surface(self):
        """What is seen there."""
        return SimpleNamespace(p=self.d, n=-self.d, ns=-self.d, is_front=np.ones(1, bool))

    def path(self, output):
        """See `textures.light_path`: only whether the camera looks is known."""
        return np.full((1, 1), {"camera": self._is_seen, "depth": not self._is_seen}.get(output, 0), np.float32)


@dataclass(frozen=True, slots=True, eq=False)
class Disk:
    """A small part of a sky that is much brighter than the rest, such as the sun.

    towards        (3, 1) float32, its middle
    one_minus_cos  float32, of its radius
    flux           its luminance times its solid angle [W m^-2]
    chance         the share of shadow rays that look for it
    """

    towards: np.ndarray
    one_minus_cos: np.float32
    flux: float = 0.0
    chance: float = 0.0

    @classmethod
    def of(cls, texture, towards, radius):
        """The disk of this `radius` [rad] around the unit vector `towards` (3,), as bright as `texture` is there."""
        # A trace wider: no place of the disk is left out because it is rounded outwards.
        disk = cls(np.array(towards, np.float32)[:, None], np.float32(2 * np.sin(0.5 * radius) ** 2 * (1 + _ROUNDING)))
        places = np.meshgrid(*[((np.arange(_GRID) + 0.5) / _GRID).astype(np.float32)] * 2)
        d = disk.sample(np.stack([p.ravel() for p in places]))
        luminance = np.tensordot(LUMINANCE, _radiance(texture, d), 1).mean()
        return replace(disk, flux=float(luminance) * 2 * np.pi * float(disk.one_minus_cos))

    def sample(self, u2):
        """Directions (3, N) within the disk, uniform, for u2 (2, N)."""
        return to_world(self.towards, square_to_cone(u2, self.one_minus_cos))

    def pdf(self, d):
        """Density (N,) of `sample` [sr^-1] times `chance`."""
        apart = d - self.towards
        # |d - towards|^2 = 2 (1 - cos): no cancellation for a small disk.
        inside = 0.5 * dot(apart, apart) <= self.one_minus_cos
        return np.where(inside, np.float32(self.chance) * square_to_cone_pdf(self.one_minus_cos), np.float32(0))


@dataclass(frozen=True, slots=True, eq=False)
class Sky(Environment):
    """An `Environment` whose radiance is a `texture`; its picture only says where to look for light, `disks` what is too small for it."""

    texture: object = None
    disks: tuple = ()

    @classmethod
    def of(cls, world):
        """From a `World` whose radiance is a texture."""
        disks = [Disk.of(world.radiance, *spot) for spot in _spots(world.radiance)]
        disks = [disk for disk in disks if 0 < disk.flux < np.inf]
        middles = np.meshgrid(*((np.arange(n) + 0.5) / n for n in SHAPE[::-1]))
        d = square_to_direction(*(m.ravel() for m in middles)).astype(np.float32)
        weight = np.tensordot(LUMINANCE, _radiance(world.radiance, d), 1)
        weight = np.minimum(weight, np.finfo(np.float32).max * 2.0**-20)
        for disk in disks:
            weight[replace(disk, chance=1.0).pdf(d) > 0] = 0
        mean = weight.mean()
        weight = np.maximum(weight, mean * _FLOOR if mean > 0 else 1).reshape(SHAPE)
        picture = EnvironmentMap(name=world.name, pixels=np.broadcast_to(weight, (3, *SHAPE)))
        found = Environment.of(replace(world, radiance=(0.0, 0.0, 0.0), environment=picture))
        for disk in disks:
            found.flux[:3] += disk.flux * disk.towards[:, 0]
            found.flux[3] += disk.flux
        scale = min(1.0, _MOST * found.flux[3] / sum(disk.flux for disk in disks)) / found.flux[3] if disks else 0.0
        disks = tuple(replace(disk, chance=disk.flux * scale) for disk in disks)
        return cls(**{name: getattr(found, name) for name in Environment.__slots__}, texture=world.radiance, disks=disks)

    def radiance(self, d):
        """See `Environment.radiance`."""
        return _radiance(self.texture, d, is_seen=True)

    def hit(self, d):
        """See `Environment.hit`."""
        u, v = direction_to_square(d)
        pdf = self._pdf(self._look_up(u, v, weighed=True)[1], v)
        if self.disks:
            pdf *= np.float32(1 - sum(disk.chance for disk in self.disks))
        for disk in self.disks:
            pdf += disk.pdf(d)
        return _radiance(self.texture, d), pdf

    def sample(self, p, u2):
        """See `interfaces.Light.sample`."""
        if not self.disks:
            wi, distance, _, pdf = Environment.sample(self, p, u2)
            return wi, distance, _radiance(self.texture, wi) / pdf, pdf
        first = sum(disk.chance for disk in self.disks)
        wi, distance, *_ = Environment.sample(self, p, _stretched(u2, first, 1.0))
        first = 0.0
        for disk in self.disks:
            last = first + disk.chance
            lanes = np.nonzero((u2[0] >= np.float32(first)) & (u2[0] < np.float32(last)))[0]
            wi[:, lanes] = disk.sample(_stretched(u2.take(lanes, axis=1), first, last))
            first = last
        L, pdf = self.hit(wi)
        return wi, distance, L / pdf, pdf


def environment_of(world):
    """The `Environment` or `Sky` of a `World` that varies."""
    return Sky.of(world) if is_texture(world.radiance) else Environment.of(world)


def _radiance(texture, d, is_seen=False):
    """L (3, N) along d (3, N); `is_seen` by the camera."""
    return np.array(np.broadcast_to(clean(Directions(d, is_seen).value(texture)), d.shape))


def _spots(texture):
    """(unit vector (3,), radius [rad]) of what is small and bright in a texture of directions; what a graph bends is not looked for."""
    for part in with_inner(texture):
        if not (hasattr(part, "spots") and isinstance(part.coordinates, Coordinates) and part.coordinates.attribute[0] in _PLACES):
            continue
        matrix = np.array(part.coordinates.matrix, np.float64)
        turn = matrix[:3, :3]
        if not matrix[:3, 3].any() and np.allclose(turn @ turn.T, np.eye(3), rtol=0, atol=_ROUNDING):
            yield from ((turn.T @ towards, radius) for towards, radius in part.spots())


def _stretched(u2, first, last):
    """u2 (2, N) whose first numbers are from `first` to `last`, brought to [0, 1)."""
    u = (u2[0] - np.float32(first)) / np.float32(last - first)
    return np.stack((np.clip(u, 0, np.float32(ONE_MINUS_EPS32)), u2[1]))
