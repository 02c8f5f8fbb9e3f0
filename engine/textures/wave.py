"""Bands and rings."""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.fractals import fractal
from ..scene.coordinates import GENERATED
from ..scene.placing import numbers, octaves, placed
from . import registry

_SHIFT, _SHRINK = np.float32(1e-6), np.float32(0.999999)
"""Blender's: waves are moved off the whole numbers, where surfaces like to lie."""
_SHAPES = {
    "bands x": lambda x, y, z: x * 20,
    "bands y": lambda x, y, z: y * 20,
    "bands z": lambda x, y, z: z * 20,
    "bands diagonal": lambda x, y, z: (x + y + z) * 10,
    "rings x": lambda x, y, z: np.sqrt(y * y + z * z) * 20,
    "rings y": lambda x, y, z: np.sqrt(x * x + z * z) * 20,
    "rings z": lambda x, y, z: np.sqrt(x * x + y * y) * 20,
    "rings spherical": lambda x, y, z: np.sqrt(x * x + y * y + z * z) * 20,
}
_TURN = np.float32(2 * math.pi)


def _triangle(n):
    n = n / _TURN
    return np.abs(n - np.floor(n + np.float32(0.5))) * 2


def _saw(n):
    n = n / _TURN
    return n - np.floor(n)


_PROFILES = {
    "sine": lambda n: np.float32(0.5) + np.float32(0.5) * np.sin(n - np.float32(math.pi / 2)),
    "saw": _saw,
    "triangle": _triangle,
}


@registry.add
@dataclass(frozen=True, eq=False)
class WaveTexture:
    """Blender's waves of 20 radians for each unit, from 0 to 1.

    scale                      how fine all is
    distortion                 by how many radians noise moves the waves
    detail, roughness, detail_scale  the octaves of that noise beyond the first; their strength; how fine they are
    phase                      what is added to the angle, radians
    shape                      "bands" along "x", "y", "z", "diagonal"; "rings" around "x", "y", "z", "spherical": as in "bands x"
    profile                    "sine", "saw", "triangle"
    """

    key = "wave"
    label = "Wave"
    is_pure = False

    coordinates: object = GENERATED
    scale: object = 1.0
    distortion: object = 0.0
    detail: object = 2.0
    roughness: object = 0.5
    detail_scale: object = 1.0
    phase: object = 0.0
    shape: str = "bands x"
    profile: str = "sine"

    def check(self, owner):
        for name, allowed in (("shape", _SHAPES), ("profile", _PROFILES)):
            if getattr(self, name) not in allowed:
                raise SceneError(f"{owner}: wave {name} is '{getattr(self, name)}', allowed: {', '.join(allowed)}")

    def eval(self, at):
        p, _ = placed(at, self.coordinates, self.scale)
        p = (p + _SHIFT) * _SHRINK
        distortion, detail, roughness, fineness, phase = numbers(
            at, self.distortion, self.detail, self.roughness, self.detail_scale, self.phase
        )
        n = _SHAPES[self.shape](*p) + phase
        if distortion.any():
            n = n + distortion * (fractal(p * fineness, None, "fbm", octaves(detail), roughness, 2.0, is_normalized=True) * 2 - 1)
        return _PROFILES[self.profile](n)[None]
