"""Smooth glass, water, and whatever else reflects and refracts without colour of its own.

The share F of exact Fresnel reflection is reflected, the rest refracted by Snell's law; one of the two is followed,
with probability F. Radiance that is refracted is scaled by 1 / eta^2, since a pencil of rays widens as it leaves the
denser medium (Veach 1997, section 5.2).
"""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.fresnel import fresnel_dielectric, refract
from ..maths.vectors import dot, reflect
from . import registry


@registry.add
@dataclass(frozen=True)
class Dielectric:
    """A smooth boundary: Fresnel reflection and refraction.

    ior            index of refraction behind the front of the surface over that before it, > 0
    reflectance    k_r, tint of what is reflected; 1 is physical
    transmittance  k_t, tint of what passes the surface, each time; 1 is physical
    """

    key = "dielectric"
    label = "Dielectric"
    is_specular = True
    transmits = True

    ior: float = 1.5
    reflectance: tuple = (1.0, 1.0, 1.0)
    transmittance: tuple = (1.0, 1.0, 1.0)

    @classmethod
    def black(cls):
        return cls(1.5, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    def row(self):
        return {"ior": self.ior, "reflectance": self.reflectance, "transmittance": self.transmittance}

    def check(self, owner):
        if not 1e-3 <= self.ior <= 1e3:
            raise SceneError(f"material '{owner}': index of refraction is {self.ior}, allowed: 0.001 to 1000")
        if not all(0 <= c < float("inf") for c in self.transmittance):
            raise SceneError(f"material '{owner}': transmittance is {self.transmittance}, allowed: three finite numbers from 0 on")

    def albedo(self):
        return tuple(max(pair) for pair in zip(self.reflectance, self.transmittance))

    @staticmethod
    def scatter(k, n, wo, is_front, u1):
        eta = np.where(is_front, k.ior, 1 / k.ior)
        is_reflected = u1 < fresnel_dielectric(dot(wo, n), eta)
        wi = np.where(is_reflected, reflect(wo, n), refract(wo, n, eta))
        return wi, np.where(is_reflected, k.reflectance, k.transmittance / (eta * eta))
