"""Textures scaled and added up."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from . import registry


@registry.add
@dataclass(frozen=True)
class LinearTexture:
    """The sum of `textures`, each times its factor (r, g, b), plus `offset` (r, g, b).

    is_clipped  each texture is cut off to [0, 1] first: pictures brighter than white, or noise about 0, as shares of light
    """

    key = "linear"
    label = "Linear Combination"
    has_detail = False

    textures: tuple = ()
    factors: tuple = ()
    offset: tuple = (0.0, 0.0, 0.0)
    is_clipped: bool = False

    def check(self, owner):
        colours = [np.asarray(c) for c in (*self.factors, self.offset)]
        are_colours = all(c.shape == (3,) and c.dtype.kind in "iuf" and np.isfinite(c).all() for c in colours)
        if len(self.factors) != len(self.textures) or not are_colours:
            raise SceneError(f"material '{owner}': a combination of textures needs three finite factors for each of them")

    def bounds(self):
        products = [self._cut(t.bounds()) * np.array(f, np.float64) for t, f in zip(self.textures, self.factors)]
        return tuple(tuple((sum(end(p, axis=0) for p in products) + np.array(self.offset)).tolist()) for end in (np.min, np.max))

    def average(self):
        terms = (self._cut(t.average()) * np.array(f, np.float64) for t, f in zip(self.textures, self.factors))
        return tuple((sum(terms) + np.array(self.offset)).tolist())

    def _cut(self, value):
        return np.clip(value, 0, 1) if self.is_clipped else np.asarray(value)

    def eval(self, at):
        total = np.array(self.offset, np.float32)[:, None]
        for texture, factor in zip(self.textures, self.factors):
            total = total + self._cut(at.value(texture)) * np.array(factor, np.float32)[:, None]
        return total
