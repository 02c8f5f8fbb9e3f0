"""Fractal noise."""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.perlin import fractal, noise, offset
from ..maths.vectors import length
from ..scene.coordinates import GENERATED
from . import registry

MOST_DETAIL = 15.0


@registry.add
@dataclass(frozen=True, eq=False)
class NoiseTexture:
    """Blender's fractal noise in three dimensions: octaves of gradient noise, each finer and weaker than the one before.

    detail         octaves beyond the first, 0 to 15; a fraction fades the last one in
    roughness      how strong each octave is, compared to the one before, >= 0
    lacunarity     how fine, likewise
    distortion     how far noise of its own moves the point where all this is looked up
    is_normalized  values are spread over [0, 1] about 1/2; else about 0
    is_coloured    each channel has noise of its own
    Octaves finer than the footprint of a ray are left out: their mean is nothing.
    """

    key = "noise"
    label = "Noise"
    has_detail = True

    coordinates: object = GENERATED
    detail: float = 2.0
    roughness: float = 0.5
    lacunarity: float = 2.0
    distortion: float = 0.0
    is_normalized: bool = True
    is_coloured: bool = False

    def check(self, owner):
        for name, most in (("detail", MOST_DETAIL), ("roughness", math.inf), ("lacunarity", math.inf), ("distortion", math.inf)):
            value = getattr(self, name)
            if not (math.isfinite(value) and value <= most and (value >= 0 or name == "distortion")):
                raise SceneError(f"material '{owner}': noise {name} is {value}, allowed: 0 to {most:g}")

    def eval(self, at):
        p, axes = at.look_up(self.coordinates)
        # Both half-axes of the footprint: half of its longest extent.
        half = None if axes is None else np.sqrt(length(axes[0]) ** 2 + length(axes[1]) ** 2)
        if self.distortion:
            p = p + np.float32(self.distortion) * np.stack([noise(p + offset(seed)) for seed in (0, 1, 2)])
        value = self._fractal(p, half)
        if not self.is_coloured:
            return value[None]
        return np.stack((value, self._fractal(p + offset(3), half), self._fractal(p + offset(4), half)))

    def _fractal(self, p, half):
        return fractal(p, half, self.detail, self.roughness, self.lacunarity, self.is_normalized)
