"""Limits of numbers."""

from dataclasses import dataclass

import numpy as np

from ..maths.ranges import clamped
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Clamp:
    """`value` at least `low` and then at most `high`; is_range: `low` may be the larger of the two."""

    key = "clamp"
    label = "Clamp"

    value: object = 0.0
    low: object = 0.0
    high: object = 1.0
    is_range: bool = False

    def check(self, owner):
        pass

    def eval(self, at):
        value, low, high = at.value(self.value), at.value(self.low), at.value(self.high)
        return clamped(value, low, high) if self.is_range else np.minimum(np.maximum(value, low), high)
