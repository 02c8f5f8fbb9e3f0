"""Fractal noise."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.fractals import FRACTALS, fractal
from ..maths.perlin import noise, offset
from ..scene.coordinates import GENERATED
from ..scene.placing import numbers, octaves, placed
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class NoiseTexture:
    """Blender's fractal noise in one to four dimensions: octaves of gradient noise, each finer and weaker than the one before.

    scale, w       how fine all is; the fourth coordinate, or the only one
    detail         octaves beyond the first, 0 to 15; a fraction fades the last one in
    roughness      how strong each octave is, compared to the one before, >= 0
    lacunarity     how fine, likewise
    offset, gain   what is added to octaves; how they count for those after them: of some kinds, see `maths.fractals`
    distortion     how far noise of its own moves the point where all this is looked up
    kind           "fbm", "multifractal", "hybrid multifractal", "ridged multifractal", "hetero terrain"
    is_normalized  values of "fbm" are spread over [0, 1] about 1/2; else about 0
    is_coloured    each channel has noise of its own
    Octaves finer than the footprint of a ray are left out: their mean is nothing.
    """

    key = "noise"
    label = "Noise"
    has_detail = True
    is_pure = False

    coordinates: object = GENERATED
    detail: object = 2.0
    roughness: object = 0.5
    lacunarity: object = 2.0
    distortion: object = 0.0
    is_normalized: bool = True
    is_coloured: bool = False
    scale: object = 1.0
    w: object = 0.0
    offset: object = 0.0
    gain: object = 1.0
    kind: str = "fbm"
    dimensions: int = 3

    def check(self, owner):
        if self.kind not in FRACTALS:
            raise SceneError(f"{owner}: noise is '{self.kind}', allowed: {', '.join(FRACTALS)}")
        if self.dimensions not in (1, 2, 3, 4):
            raise SceneError(f"{owner}: noise has {self.dimensions} dimensions, allowed: 1 to 4")

    def eval(self, at):
        p, half = placed(at, self.coordinates, self.scale, self.w, self.dimensions)
        detail, roughness, lacunarity, distortion, added, gain = numbers(
            at, self.detail, self.roughness, self.lacunarity, self.distortion, self.offset, self.gain
        )

        def moved(number):
            return p + offset(number, self.dimensions)

        def value(p):
            roughness_ = np.maximum(roughness, 0)
            return fractal(p, half, self.kind, octaves(detail), roughness_, lacunarity, added, gain, self.is_normalized)

        if distortion.any():
            p = p + distortion * np.stack([noise(moved(i)) for i in range(self.dimensions)])
        if not self.is_coloured:
            return value(p)[None]
        return np.stack((value(p), value(moved(self.dimensions)), value(moved(self.dimensions + 1))))
