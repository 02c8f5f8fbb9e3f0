"""Vectors as numbers."""

from dataclasses import dataclass

import numpy as np

from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Average:
    """The mean of the components of a vector."""

    key = "average"
    label = "Average"

    vector: object = (0.0, 0.0, 0.0)

    def check(self, owner):
        pass

    def eval(self, at):
        value = at.value(self.vector)
        return value if len(value) == 1 else ((value[0] + value[1] + value[2]) * np.float32(1 / 3))[None]
