"""Glossy reflection: the modified Phong lobe of Lafortune and Willems 1994, CW 197.

The lobe is a power of the cosine about the mirror direction r of wo:

    f = k_s (n + 2) / (2 pi) max(r . wi, 0)^n                                      (eq. 6, specular part)

It is reciprocal, and reflects at most k_s. It has no 1 / cos: for n -> infinity it tends to the mirror times
the cosine of incidence. It is sampled with density (n + 1) / (2 pi) cos^n about r (eq. 9); directions that fall
below the surface carry nothing and still count.
"""

from dataclasses import dataclass

from ..maths.lobes import Highlight, phong_lobe, sample_lobe, sample_lobe_pdf
from ..maths.vectors import cosine_power, reflect
from . import registry


@registry.add
@dataclass(frozen=True)
class Phong(Highlight):
    """f = k_s (n + 2) / (2 pi) cos^n of the angle to the mirror direction; `exponent` n >= 0, large is sharp."""

    key = "phong"
    label = "Phong"
    is_reciprocal = True

    @staticmethod
    def eval(k, n, wo, wi):
        return k.reflectance * phong_lobe(reflect(wo, n), wi, k.exponent)

    @staticmethod
    def illuminate(k, n, wo, wi):
        return k.reflectance * cosine_power(reflect(wo, n), wi, k.exponent)

    @staticmethod
    def sample(k, n, wo, u2):
        return sample_lobe(reflect(wo, n), u2, k.exponent)

    @staticmethod
    def pdf(k, n, wo, wi):
        return sample_lobe_pdf(reflect(wo, n), wi, k.exponent)
