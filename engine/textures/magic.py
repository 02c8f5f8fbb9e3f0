"""Folded sines."""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..scene.coordinates import GENERATED
from ..scene.placing import numbers
from . import registry

_TURN = np.float32(2 * math.pi)
_MOST_DEPTH = 10
_FOLDS = (
    ("y", lambda x, y, z: -np.cos(x - y + z)),
    ("x", lambda x, y, z: np.cos(x - y - z)),
    ("z", lambda x, y, z: np.sin(-x - y - z)),
    ("x", lambda x, y, z: -np.cos(-x + y - z)),
    ("y", lambda x, y, z: -np.sin(-x + y + z)),
    ("y", lambda x, y, z: -np.cos(-x + y + z)),
    ("x", lambda x, y, z: np.cos(x + y + z)),
    ("z", lambda x, y, z: np.sin(x + y - z)),
    ("x", lambda x, y, z: -np.cos(-x - y + z)),
    ("y", lambda x, y, z: -np.sin(x - y + z)),
)
"""Which coordinate each fold replaces, and by what."""


@registry.add
@dataclass(frozen=True, eq=False)
class MagicTexture:
    """Blender's colours of sines of sines.

    scale         how fine all is
    distortion    how far each fold reaches
    depth         how many folds, 0 to 10
    output        "color", or "fac": its mean
    scales_first  repeats every 2 pi after scaling, as from Blender 5.2 on; else before
    """

    key = "magic"
    label = "Magic"
    is_pure = False

    coordinates: object = GENERATED
    scale: object = 1.0
    distortion: object = 1.0
    depth: int = 2
    output: str = "color"
    scales_first: bool = True

    def check(self, owner):
        if self.depth not in range(_MOST_DEPTH + 1):
            raise SceneError(f"{owner}: magic depth is {self.depth}, allowed: 0 to {_MOST_DEPTH}")
        if self.output not in ("color", "fac"):
            raise SceneError(f"{owner}: magic gives '{self.output}', allowed: color, fac")

    def eval(self, at):
        p, _ = at.look_up(self.coordinates)
        scale, distortion = numbers(at, self.scale, self.distortion)
        px, py, pz = np.fmod(p * scale, _TURN) if self.scales_first else np.fmod(p, _TURN)
        sums = (px + py + pz) * 5, (-px + py - pz) * 5, (-px - py + pz) * 5
        if not self.scales_first:
            sums = [s * scale for s in sums]
        found = {"x": np.sin(sums[0]), "y": np.cos(sums[1]), "z": -np.cos(sums[2])}
        if self.depth:
            found = {name: value * distortion for name, value in found.items()}
        for name, fold in _FOLDS[: self.depth]:
            found[name] = fold(**found) * distortion
        colour = np.float32(0.5) - np.stack(list(found.values())) / np.where(distortion == 0, 1, 2 * distortion)
        return colour if self.output == "color" else ((colour[0] + colour[1] + colour[2]) * np.float32(1 / 3))[None]
