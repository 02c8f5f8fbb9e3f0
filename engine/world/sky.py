"""A texture of all directions around a scene as a light: worked out where rays escape, and sampled in proportion to a picture of it."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np

from ..constants import LUMINANCE
from ..maths.equirect import direction_to_square, square_to_direction
from ..scene.environment import EnvironmentMap
from ..scene.points import OnPlane
from ..scene.textured import is_texture
from .environment import Environment
from .texturing import clean

SHAPE = (256, 512)
"""Rows and columns of the picture by which directions are chosen; what it misses is found by scattered rays."""
_PLACES = ("generated", "object", "position", "camera")
_FLOOR = 2.0**-6
"""Every direction is chosen at least so often, compared to the mean."""


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
class Sky(Environment):
    """An `Environment` whose radiance is a `texture`; its picture only says where to look for light."""

    texture: object = None

    @classmethod
    def of(cls, world):
        """From a `World` whose radiance is a texture."""
        middles = np.meshgrid(*((np.arange(n) + 0.5) / n for n in SHAPE[::-1]))
        d = square_to_direction(*(m.ravel() for m in middles)).astype(np.float32)
        weight = np.tensordot(LUMINANCE, _radiance(world.radiance, d), 1)
        weight = np.minimum(weight, np.finfo(np.float32).max * 2.0**-20)
        mean = weight.mean()
        weight = np.maximum(weight, mean * _FLOOR if mean > 0 else 1).reshape(SHAPE)
        picture = EnvironmentMap(name=world.name, pixels=np.broadcast_to(weight, (3, *SHAPE)))
        found = Environment.of(replace(world, radiance=(0.0, 0.0, 0.0), environment=picture))
        return cls(**{name: getattr(found, name) for name in Environment.__slots__}, texture=world.radiance)

    def radiance(self, d):
        """See `Environment.radiance`."""
        return _radiance(self.texture, d, is_seen=True)

    def hit(self, d):
        """See `Environment.hit`."""
        u, v = direction_to_square(d)
        return _radiance(self.texture, d), self._pdf(self._look_up(u, v, weighed=True)[1], v)

    def sample(self, p, u2):
        """See `interfaces.Light.sample`."""
        wi, distance, _, pdf = Environment.sample(self, p, u2)
        return wi, distance, _radiance(self.texture, wi) / pdf, pdf


def environment_of(world):
    """The `Environment` or `Sky` of a `World` that varies."""
    return Sky.of(world) if is_texture(world.radiance) else Environment.of(world)


def _radiance(texture, d, is_seen=False):
    """L (3, N) along d (3, N); `is_seen` by the camera."""
    return np.array(np.broadcast_to(clean(Directions(d, is_seen).value(texture)), d.shape))
