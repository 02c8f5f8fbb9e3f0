"""Ideal diffuse transmission: light that passes a thin sheet and leaves it evenly, as it does paper or a leaf."""

from dataclasses import dataclass

import numpy as np

from ..constants import INV_PI
from ..maths.frames import to_world
from ..maths.vectors import dot
from ..maths.warps import square_to_cosine_hemisphere
from . import registry


@registry.add
@dataclass(frozen=True)
class LambertTransmission:
    """f = k_t / pi for light from the other side, and k_t is the share of light that passes, per channel."""

    key = "lambert_transmission"
    label = "Lambert Transmission"
    is_specular = False
    transmits = True
    is_reciprocal = True
    is_diffuse = True

    transmittance: tuple = (0.8, 0.8, 0.8)

    @classmethod
    def black(cls):
        return cls((0.0, 0.0, 0.0))

    def row(self):
        return {"transmittance": self.transmittance}

    @staticmethod
    def albedo(k):
        return k.transmittance

    def check(self, owner):
        pass

    @staticmethod
    def eval(k, n, wo, wi):
        return k.transmittance * INV_PI

    @staticmethod
    def illuminate(k, n, wo, wi):
        return k.transmittance * np.maximum(-dot(n, wi), 0)

    @staticmethod
    def sample(k, n, wo, u2):
        return to_world(-n, square_to_cosine_hemisphere(u2))

    @staticmethod
    def pdf(k, n, wo, wi):
        return np.maximum(-dot(n, wi), 0) * INV_PI
