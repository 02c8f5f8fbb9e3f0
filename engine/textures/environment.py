"""Pictures of all directions."""

from dataclasses import dataclass

import numpy as np

from ..maths import interpolation
from ..maths.equirect import direction_to_square
from ..maths.vectors import length
from ..scene.coordinates import GENERATED
from ..scene.environment import EnvironmentMap
from . import registry

_TEXELS = {"linear": interpolation.linear_texels, "closest": interpolation.nearest_texels}
_GREY = EnvironmentMap(name="grey", pixels=np.full((3, 1, 1), 0.5))


@registry.add
@dataclass(frozen=True, eq=False)
class EnvironmentTexture:
    """An `EnvironmentMap`, turned and as strong as that says, looked up in the direction of `coordinates`, whatever their length."""

    key = "environment"
    label = "Environment"

    picture: EnvironmentMap = _GREY
    coordinates: object = GENERATED

    def check(self, owner):
        pass

    def eval(self, at):
        d, _ = at.look_up(self.coordinates)
        d = d / np.maximum(length(d), np.finfo(np.float32).tiny)
        # Term by term, as what a product of matrices rounds depends on the number of lanes.
        d = np.stack([row[0] * d[0] + row[1] * d[1] + row[2] * d[2] for row in self.picture.world_from_map.T.astype(np.float32)])
        _, height, width = self.picture.pixels.shape
        pixels = self.picture.pixels.reshape(3, -1)
        taps = _TEXELS[self.picture.interpolation](*direction_to_square(d), (height, width))
        # What is no direction has some texel.
        value = sum(pixels.take(row * width + column, axis=1, mode="clip") * weight for row, column, weight in taps)
        return value * np.array(self.picture.strength, np.float32)[:, None]
