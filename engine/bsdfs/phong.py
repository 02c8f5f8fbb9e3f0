"""Glossy reflection: the modified Phong lobe of Lafortune and Willems 1994, CW 197.

The lobe is a power of the cosine about the mirror direction r of wo:

    f = k_s (n + 2) / (2 pi) max(r . wi, 0)^n                                      (eq. 6, specular part)

It is reciprocal, and reflects at most k_s. It has no 1 / cos: for n -> infinity it tends to the mirror times
the cosine of incidence. It is sampled with density (n + 1) / (2 pi) cos^n about r (eq. 9); directions that fall
below the surface carry nothing and still count.
"""

from dataclasses import dataclass

from ..constants import INV_PI
from ..errors import SceneError
from ..maths.frames import to_world
from ..maths.vectors import cosine_power, reflect
from ..maths.warps import square_to_cosine_power
from . import registry

LARGEST_EXPONENT = 1e6
"""A lobe 0.1 degrees wide; float32 directions cannot carry a sharper one."""


@registry.add
@dataclass(frozen=True)
class Phong:
    """f = k_s (n + 2) / (2 pi) cos^n of the angle to the mirror direction; `exponent` n >= 0, large is sharp."""

    key = "phong"
    label = "Phong"
    is_specular = False
    transmits = False

    reflectance: tuple = (0.8, 0.8, 0.8)
    exponent: float = 32.0

    @classmethod
    def black(cls):
        return cls((0.0, 0.0, 0.0))

    def row(self):
        return {"reflectance": self.reflectance, "exponent": self.exponent}

    def albedo(self):
        return self.reflectance

    def check(self, owner):
        if not 0 <= self.exponent <= LARGEST_EXPONENT:
            raise SceneError(f"material '{owner}': Phong exponent is {self.exponent}, allowed: 0 to {LARGEST_EXPONENT:g}")

    @staticmethod
    def eval(k, n, wo, wi):
        lobe = (k.exponent + 2) * (0.5 * INV_PI) * cosine_power(reflect(wo, n), wi, k.exponent)
        return k.reflectance * lobe

    @staticmethod
    def sample(k, n, wo, u2):
        return to_world(reflect(wo, n), square_to_cosine_power(u2, k.exponent))

    @staticmethod
    def pdf(k, n, wo, wi):
        return (k.exponent + 1) * (0.5 * INV_PI) * cosine_power(reflect(wo, n), wi, k.exponent)
