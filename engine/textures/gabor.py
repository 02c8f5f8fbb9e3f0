"""Waves at random places."""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.gabor import SPREADS, phasor
from ..maths.vectors import as_vector
from ..scene.coordinates import GENERATED
from ..scene.placing import numbers, placed, shared_key
from . import registry

_LEAST_FREQUENCY = np.float32(0.001)
_PI = np.float32(math.pi)


@registry.add
@dataclass(frozen=True, eq=False)
class GaborTexture:
    """Blender's Gabor noise: short waves at random places.

    scale        how fine all is
    frequency    waves for each unit, at least 0.001
    anisotropy   from 0, waves along all directions, to 1, all along one
    angle        that direction in two dimensions, radians
    orientation  that direction in three dimensions, of any length
    dimensions   2 or 3
    output       "value" and "intensity", about [0, 1]; "phase", [0, 1]
    """

    key = "gabor"
    label = "Gabor"
    is_pure = False

    coordinates: object = GENERATED
    scale: object = 1.0
    frequency: object = 2.0
    anisotropy: object = 1.0
    angle: object = math.pi / 4
    orientation: object = (math.sqrt(0.5), math.sqrt(0.5), 0.0)
    dimensions: int = 2
    output: str = "value"

    def check(self, owner):
        if self.dimensions not in (2, 3):
            raise SceneError(f"{owner}: Gabor noise has {self.dimensions} dimensions, allowed: 2, 3")
        if self.output not in ("value", "phase", "intensity"):
            raise SceneError(f"{owner}: Gabor noise gives '{self.output}', allowed: value, phase, intensity")

    def eval(self, at):
        cosine, sine = at.once(shared_key(self, but="output"), lambda: self._phasor(at))
        spread = np.float32(SPREADS[self.dimensions])
        if self.output == "value":
            return (sine / spread * np.float32(0.5) + np.float32(0.5))[None]
        if self.output == "phase":
            return ((np.arctan2(sine, cosine) + _PI) / (2 * _PI))[None]
        return (np.sqrt(cosine * cosine + sine * sine) / spread)[None]

    def _phasor(self, at):
        p, _ = placed(at, self.coordinates, self.scale, dimensions=self.dimensions)
        frequency, anisotropy, orientation = numbers(at, self.frequency, self.anisotropy, self.angle)
        if self.dimensions == 3:
            orientation = as_vector(at.value(self.orientation))
            x, y, z = orientation
            with np.errstate(divide="ignore", invalid="ignore"):
                orientation = orientation / np.sqrt(x * x + y * y + z * z)
        with np.errstate(invalid="ignore", divide="ignore"):
            return phasor(p, np.fmax(frequency, _LEAST_FREQUENCY), 1 - np.clip(anisotropy, 0, 1), orientation)
