"""Translucency: light passes a thin sheet and is scattered about its way straight on (Cook, Porter and Carpenter 1984).

The lobe is Phong's, about -wo instead of the mirror direction:

    f = k_t (n + 2) / (2 pi) max(-wo . wi, 0)^n

Mirrored at the sheet, wi is on the side of wo, and this is the modified Phong lobe of Lafortune and Willems 1994: so it
is reciprocal, passes at most k_t, and for n -> infinity tends to a clear sheet times the cosine of incidence.
"""

from dataclasses import dataclass

from ..maths.lobes import LARGEST_EXPONENT, check_exponent, phong_lobe, sample_lobe, sample_lobe_pdf
from ..maths.vectors import cosine_power
from . import registry


@registry.add
@dataclass(frozen=True)
class PhongTransmission:
    """f = k_t (n + 2) / (2 pi) cos^n of the angle to the way straight on; `exponent` n >= 0, large is clear."""

    key = "phong_transmission"
    label = "Phong Transmission"
    is_specular = False
    transmits = True
    is_reciprocal = True
    is_diffuse = False
    limits = {"exponent": (0.0, LARGEST_EXPONENT)}

    transmittance: tuple = (0.8, 0.8, 0.8)
    exponent: float = 32.0

    @classmethod
    def black(cls):
        return cls((0.0, 0.0, 0.0))

    def row(self):
        return {"transmittance": self.transmittance, "exponent": self.exponent}

    @staticmethod
    def albedo(k):
        return k.transmittance

    def check(self, owner):
        check_exponent(f"material '{owner}': Phong exponent", self.exponent)

    @staticmethod
    def eval(k, n, wo, wi):
        return k.transmittance * phong_lobe(-wo, wi, k.exponent)

    @staticmethod
    def illuminate(k, n, wo, wi):
        return k.transmittance * cosine_power(-wo, wi, k.exponent)

    @staticmethod
    def sample(k, n, wo, u2):
        return sample_lobe(-wo, u2, k.exponent)

    @staticmethod
    def pdf(k, n, wo, wi):
        return sample_lobe_pdf(-wo, wi, k.exponent)
