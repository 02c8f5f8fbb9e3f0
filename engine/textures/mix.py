"""What is between two numbers or vectors."""

from dataclasses import dataclass

import numpy as np

from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Mix:
    """a (1 - factor) + b factor, of numbers or vectors, with one factor or one for each component; is_clamped: cut off to [0, 1]."""

    key = "mix"
    label = "Mix"

    factor: object = 0.5
    a: object = (0.0, 0.0, 0.0)
    b: object = (0.0, 0.0, 0.0)
    is_clamped: bool = True

    def check(self, owner):
        pass

    def eval(self, at):
        t = at.value(self.factor)
        t = np.clip(t, 0, 1) if self.is_clamped else t
        return at.value(self.a) * (1 - t) + at.value(self.b) * t
