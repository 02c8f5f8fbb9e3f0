"""Ideal diffuse reflection: the same radiance into every direction (Lambert 1760)."""

from dataclasses import dataclass

import numpy as np

from ..constants import INV_PI
from ..maths.frames import to_world
from ..maths.vectors import dot
from ..maths.warps import square_to_cosine_hemisphere
from . import registry


@registry.add
@dataclass(frozen=True)
class Lambert:
    """f = k_d / pi, and k_d is the share of light reflected, per channel."""

    key = "lambert"
    label = "Lambert"
    is_specular = False
    transmits = False
    is_reciprocal = True
    is_diffuse = True

    reflectance: tuple = (0.8, 0.8, 0.8)

    @classmethod
    def black(cls):
        return cls((0.0, 0.0, 0.0))

    def row(self):
        return {"reflectance": self.reflectance}

    @staticmethod
    def albedo(k):
        return k.reflectance

    def check(self, owner):
        pass

    @staticmethod
    def eval(k, n, wo, wi):
        return k.reflectance * INV_PI

    @staticmethod
    def illuminate(k, n, wo, wi):
        return k.reflectance * np.maximum(dot(n, wi), 0)

    @staticmethod
    def sample(k, n, wo, u2):
        return to_world(n, square_to_cosine_hemisphere(u2))

    @staticmethod
    def pdf(k, n, wo, wi):
        return np.maximum(dot(n, wi), 0) * INV_PI
