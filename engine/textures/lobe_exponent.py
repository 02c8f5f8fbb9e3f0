"""How sharp a lobe is that is as wide as Blender's roughness has it."""

from dataclasses import dataclass

import numpy as np

from ..maths.ggx import exponent_of_reflection, exponent_of_refraction
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class LobeExponent:
    """The exponent of a cosine's power with half of the light within the same angle as that of GGX, see `maths.ggx`.

    roughness  Blender's, 0 to 1
    eta        relative index of refraction of a refracted lobe; 0: the lobe is reflected
    """

    key = "lobe exponent"
    label = "Lobe Exponent"

    roughness: object = 0.5
    eta: object = 0.0

    def check(self, owner):
        pass

    def eval(self, at):
        roughness = np.nan_to_num(at.value(self.roughness)[:1])
        if self.eta == 0.0:
            return exponent_of_reflection(roughness)
        return exponent_of_refraction(roughness, np.clip(np.nan_to_num(at.value(self.eta)[:1]), 1e-3, 1e3))
