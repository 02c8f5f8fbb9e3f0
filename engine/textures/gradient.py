"""Smooth transitions from black to white."""

from dataclasses import dataclass

import numpy as np

from ..constants import INV_PI
from ..errors import SceneError
from ..maths.vectors import length
from ..scene.coordinates import GENERATED
from . import registry

_RADIUS = 0.999999
"""Blender's spheres are a trace smaller than 1."""


def _sphere(x, y, z):
    return np.maximum(np.float32(_RADIUS) - length((x, y, z)), 0)


def _eased(x, y, z):
    t = np.clip(x, 0, 1)
    return t * t * (3 - 2 * t)


_SHAPES = {
    "linear": lambda x, y, z: x,
    "quadratic": lambda x, y, z: np.maximum(x, 0) ** 2,
    "easing": _eased,
    "diagonal": lambda x, y, z: np.float32(0.5) * (x + y),
    "radial": lambda x, y, z: np.arctan2(y, x) * np.float32(0.5 * INV_PI) + np.float32(0.5),
    "quadratic sphere": lambda x, y, z: _sphere(x, y, z) ** 2,
    "spherical": _sphere,
}


@registry.add
@dataclass(frozen=True, eq=False)
class GradientTexture:
    """Grey from 0 to 1 by `shape`, as Blender's: linear, quadratic, easing, diagonal, radial, quadratic sphere or spherical.

    linear, quadratic, easing   x, x^2, 3 x^2 - 2 x^3
    diagonal, radial            (x + y) / 2; the angle about z, from -x on
    spherical, quadratic sphere 1 - r, (1 - r)^2 around the origin
    """

    key = "gradient"
    label = "Gradient"

    shape: str = "linear"
    coordinates: object = GENERATED

    def check(self, owner):
        if self.shape not in _SHAPES:
            raise SceneError(f"{owner}: gradient is '{self.shape}', allowed: {', '.join(_SHAPES)}")

    def eval(self, at):
        p, _ = at.look_up(self.coordinates)
        value = np.clip(_SHAPES[self.shape](*p), 0, 1)
        return value[None]
