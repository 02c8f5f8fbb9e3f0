"""Glossy reflection: Phong's illumination model of 1975 as a BRDF, as the lecture has it.

Phong's highlight is not weakened by the cosine of incidence, so as a BRDF it is divided by it (C. Dachsbacher,
Computergrafik, chapter 2; Lewis 1994, "Making shaders more physically plausible", eq. 7):

    f = k_s (n + 2) / (2 pi) max(r . wi, 0)^n / max(n . wi, 0)

The division makes it irreciprocal, and grazing light as bright as any. The cosine that it takes away is also what
(n + 2) / (2 pi) counts on: what is reflected is k_s (n + 2) / (n + 1) times the part of the lobe above the horizon,
and all of the lobe is above at normal incidence. So no more light leaves than arrives for k_s <= (n + 1) / (n + 2).
"""

from dataclasses import dataclass

import numpy as np

from ..constants import EPS32
from ..maths.lobes import Highlight, phong_lobe, sample_lobe, sample_lobe_pdf
from ..maths.vectors import cosine_power, dot, reflect
from . import registry


@registry.add
@dataclass(frozen=True)
class PhongLecture(Highlight):
    """f = k_s (n + 2) / (2 pi) cos^n of the angle to the mirror direction, over the cosine of incidence.

    reflectance  k_s, at most (n + 1) / (n + 2)
    exponent     n >= 0, large is sharp
    """

    key = "phong_lecture"
    label = "Phong (Lecture)"
    is_reciprocal = False

    @staticmethod
    def albedo(k):
        return k.reflectance * ((k.exponent + 2) / (k.exponent + 1))

    @staticmethod
    def eval(k, n, wo, wi):
        # A cosine below EPS32 is the rounding of directions.
        return k.reflectance * (phong_lobe(reflect(wo, n), wi, k.exponent) / np.maximum(dot(n, wi), EPS32))

    @staticmethod
    def illuminate(k, n, wo, wi):
        return k.reflectance * cosine_power(reflect(wo, n), wi, k.exponent)

    @staticmethod
    def sample(k, n, wo, u2):
        return sample_lobe(reflect(wo, n), u2, k.exponent)

    @staticmethod
    def pdf(k, n, wo, wi):
        return sample_lobe_pdf(reflect(wo, n), wi, k.exponent)
