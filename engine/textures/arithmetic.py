"""Operations on numbers."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.arithmetic import NUMBERS, operands
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Math:
    """Blender's Math: `operation`, see `maths.arithmetic.NUMBERS`, of as many of a, b, c as it takes; is_clamped: cut off to [0, 1]."""

    key = "math"
    label = "Math"

    a: object = 0.5
    b: object = 0.5
    c: object = 0.5
    operation: str = "add"
    is_clamped: bool = False

    def check(self, owner):
        if self.operation not in NUMBERS:
            raise SceneError(f"{owner}: operation of Math is '{self.operation}', allowed: {', '.join(NUMBERS)}")

    def eval(self, at):
        function = NUMBERS[self.operation]
        with np.errstate(all="ignore"):
            value = function(*(at.value(x) for x in (self.a, self.b, self.c)[: operands(function)]))
        return np.clip(value, 0, 1) if self.is_clamped else value
