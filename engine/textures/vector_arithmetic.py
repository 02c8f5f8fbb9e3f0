"""Operations on vectors."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.arithmetic import TRIPLES, operands
from ..maths.vectors import as_vector
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class VectorMath:
    """Blender's Vector Math: `operation`, see `maths.arithmetic.TRIPLES`, of as many of a, b, c as it takes.

    The factor of "scale" is b, and the relative index of "refract" is c.
    """

    key = "vector math"
    label = "Vector Math"

    a: object = (0.0, 0.0, 0.0)
    b: object = (0.0, 0.0, 0.0)
    c: object = (0.0, 0.0, 0.0)
    operation: str = "add"

    def check(self, owner):
        if self.operation not in TRIPLES:
            raise SceneError(f"{owner}: operation of Vector Math is '{self.operation}', allowed: {', '.join(TRIPLES)}")

    def eval(self, at):
        function = TRIPLES[self.operation]
        with np.errstate(all="ignore"):
            return function(*(as_vector(at.value(x)) for x in (self.a, self.b, self.c)[: operands(function)]))
