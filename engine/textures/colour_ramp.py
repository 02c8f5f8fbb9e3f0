"""Colours along a scale."""

from dataclasses import dataclass, field

import numpy as np

from ..maths.tables import check_table, look_up
from ..scene.placing import numbers
from . import registry


def _black_to_white():
    return np.linspace(0, 1, 256, dtype=np.float32) * np.ones((3, 1), np.float32)


@registry.add
@dataclass(frozen=True, eq=False)
class ColourRamp:
    """Blender's Color Ramp: `table` (3 or 1, K >= 2) holds what is at K equal steps of `factor` from 0 to 1; the ends go on.

    is_smooth  linear between the steps; else the step below
    """

    key = "colour ramp"
    label = "Color Ramp"

    factor: object = 0.5
    table: np.ndarray = field(default_factory=_black_to_white)
    is_smooth: bool = True

    def check(self, owner):
        check_table(self.table, f"{owner}: table of Color Ramp")

    def eval(self, at):
        (factor,) = numbers(at, self.factor)
        return look_up(self.table, factor[None], self.is_smooth)
