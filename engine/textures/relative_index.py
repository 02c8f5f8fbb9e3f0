"""The index of refraction of what is on the far side of a surface, over that of what is on the near one."""

from dataclasses import dataclass

import numpy as np

from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class RelativeIndex:
    """`ior` over the index of what is around the body, seen from the front; seen from within the inverse of that.

    Around a body is the vacuum, or the medium of another one that it lies in, see `scene.medium`.
    """

    key = "relative index"
    label = "Relative Index"
    is_pure = False
    asks_for_cosine = True
    asks_for_around = True

    ior: object = 1.5

    def check(self, owner):
        pass

    def eval(self, at):
        ior = np.clip(np.nan_to_num(at.value(self.ior)[:1]), 1e-3, 1e3)
        return np.where(at.surface.is_front, ior / at.around, at.around / ior).astype(np.float32)
