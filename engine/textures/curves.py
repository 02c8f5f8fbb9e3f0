"""Values bent by curves."""

import math
from dataclasses import dataclass, field

import numpy as np

from ..errors import SceneError
from ..maths.tables import check_table, look_up
from ..maths.vectors import as_vector
from . import registry


def _straight():
    return np.linspace(0, 1, 256, dtype=np.float32)[None]


@registry.add
@dataclass(frozen=True, eq=False)
class Curves:
    """Blender's Float Curve, or its RGB or Vector Curves, by `factor`.

    table    (1, K) what is at K equal steps of a number from `low` to `high`; (3, K): of each component of a vector
    goes_on  beyond the ends the curve goes on straight; else it stays what it is there
    """

    key = "curves"
    label = "Curves"

    value: object = 0.0
    factor: object = 1.0
    table: np.ndarray = field(default_factory=_straight)
    low: float = 0.0
    high: float = 1.0
    goes_on: bool = True

    def check(self, owner):
        check_table(self.table, f"{owner}: table of Curves")
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise SceneError(f"{owner}: Curves go from {self.low} to {self.high}, allowed: upwards")

    def eval(self, at):
        value, factor = at.value(self.value), at.value(self.factor)
        value = as_vector(value) if len(self.table) == 3 else value[:1]
        place = (value - np.float32(self.low)) / np.float32(self.high - self.low)
        return (1 - factor) * value + factor * look_up(self.table, place, goes_on=self.goes_on)
