"""Powers of colours."""

from dataclasses import dataclass

import numpy as np

from ..maths.vectors import as_vector
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Gamma:
    """Blender's Gamma: colour^gamma, channel by channel; what is not above 0 stays as it is, and a gamma of 0 makes white."""

    key = "gamma"
    label = "Gamma"

    colour: object = (1.0, 1.0, 1.0)
    gamma: object = 1.0

    def check(self, owner):
        pass

    def eval(self, at):
        colour, gamma = as_vector(at.value(self.colour)), at.value(self.gamma)
        with np.errstate(over="ignore"):
            raised = np.where(colour > 0, np.power(np.where(colour > 0, colour, 1), gamma), colour)
        return np.where(gamma == 0, np.float32(1), raised)
