"""One range of numbers as another."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.ranges import PROGRESS, clamped
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class MapRange:
    """Blender's Map Range: `value` goes from to_low to to_high as it goes from from_low to from_high; of numbers or vectors.

    interpolation  how, see `maths.ranges.PROGRESS`; only "stepped" asks for `steps`
    is_clamped     the result stays between to_low and to_high
    is_number      a number from a range without extent is 0, not to_low as the components of a vector are
    """

    key = "map range"
    label = "Map Range"

    value: object = 1.0
    from_low: object = 0.0
    from_high: object = 1.0
    to_low: object = 0.0
    to_high: object = 1.0
    steps: object = 4.0
    interpolation: str = "linear"
    is_clamped: bool = True
    is_number: bool = True

    def check(self, owner):
        if self.interpolation not in PROGRESS:
            allowed = ", ".join(PROGRESS)
            raise SceneError(f"{owner}: interpolation of Map Range is '{self.interpolation}', allowed: {allowed}")

    def eval(self, at):
        low, high, to_low, to_high = (at.value(x) for x in (self.from_low, self.from_high, self.to_low, self.to_high))
        with np.errstate(over="ignore", invalid="ignore"):
            progress = PROGRESS[self.interpolation](at.value(self.value), low, high, at.value(self.steps))
            result = to_low + progress * (to_high - to_low)
        if self.is_number:
            result = np.where(low != high, result, np.float32(0))
        return clamped(result, to_low, to_high) if self.is_clamped else result
