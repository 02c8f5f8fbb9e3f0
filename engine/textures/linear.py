"""Textures scaled and added up."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class LinearTexture:
    """The sum of `textures`, each times its factor, plus `offset`; factors and offset are inputs: numbers, colours or textures.

    is_clipped  each texture is cut off to [0, 1] first: pictures brighter than white, or noise about 0, as shares of light
    """

    key = "linear"
    label = "Linear Combination"

    textures: tuple = ()
    factors: tuple = ()
    offset: object = 0.0
    is_clipped: bool = False

    def check(self, owner):
        are_inputs = all(hasattr(c, "eval") or np.shape(c) in ((), (3,)) for c in self.factors)
        if len(self.factors) != len(self.textures) or not are_inputs:
            raise SceneError(f"{owner}: a combination of textures needs a factor for each of them, one or three numbers")

    def eval(self, at):
        total = at.value(self.offset)
        for texture, factor in zip(self.textures, self.factors):
            value = at.value(texture)
            total = total + (np.clip(value, 0, 1) if self.is_clipped else value) * at.value(factor)
        return total
