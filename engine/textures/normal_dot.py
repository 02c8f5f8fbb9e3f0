"""How far vectors point into one direction."""

from dataclasses import dataclass

import numpy as np

from ..maths.facing import unit
from ..maths.vectors import as_vector, dot
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class NormalDot:
    """The cosine between `vector` and `direction`."""

    key = "normal dot"
    label = "Normal"

    vector: object = (0.0, 0.0, 1.0)
    direction: tuple = (0.0, 0.0, 1.0)

    def check(self, owner):
        pass

    def eval(self, at):
        return dot(unit(np.array(self.direction, np.float32)[:, None]), unit(as_vector(at.value(self.vector))))[None]
