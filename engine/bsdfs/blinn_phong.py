"""Glossy reflection: Blinn's variant of Phong's lobe, about the half vector (Blinn 1977).

    f = k_s (n + 2)(n + 4) / (8 pi (2^(-n/2) + n)) max(h . n, 0)^n,   h = (wo + wi) / |wo + wi|

It is reciprocal. The factor makes the share reflected at normal incidence exactly k_s (Giesen 2009, "Phong
normalization factor derivation"; Akenine-Moeller et al., Real-Time Rendering, give its approximation (n + 8) / (8 pi));
towards grazing it falls, so nowhere is it more. For n -> infinity it tends to the mirror times cos^2 of incidence.

Sampled by the half vector with density (n + 1) / (2 pi) cos^n about n; the direction that mirrors wo about it has
the density of the half vector over 4 (wo . h) (Torrance and Sparrow 1967; Walter et al. 2007, eq. 14).
"""

from dataclasses import dataclass

import numpy as np

from ..constants import PI
from ..maths.lobes import Highlight, sample_lobe, sample_lobe_pdf
from ..maths.vectors import cosine_power, dot, length, reflect
from . import registry


@registry.add
@dataclass(frozen=True)
class BlinnPhong(Highlight):
    """f = k_s c(n) cos^n of the angle between normal and half vector; `exponent` n >= 0, large is sharp.

    The highlight is stretched towards grazing angles; seen straight it is as wide as Phong's of exponent n / 4.
    """

    key = "blinn_phong"
    label = "Blinn-Phong"
    is_reciprocal = True

    exponent: float = 128.0

    @staticmethod
    def eval(k, n, wo, wi):
        h, _ = _half_vector(n, wo, wi)
        return k.reflectance * (factor(k.exponent) * cosine_power(n, h, k.exponent))

    @staticmethod
    def illuminate(k, n, wo, wi):
        h, _ = _half_vector(n, wo, wi)
        return k.reflectance * cosine_power(n, h, k.exponent)

    @staticmethod
    def sample(k, n, wo, u2):
        return reflect(wo, sample_lobe(n, u2, k.exponent))

    @staticmethod
    def pdf(k, n, wo, wi):
        h, cos = _half_vector(n, wo, wi)
        return sample_lobe_pdf(n, h, k.exponent) / (4 * cos)


def factor(exponent):
    """(n + 2)(n + 4) / (8 pi (2^(-n/2) + n)), (N,): with it all is reflected at normal incidence."""
    return (exponent + 2) * (exponent + 4) / (8 * PI * (np.exp2(-0.5 * exponent) + exponent))


def _half_vector(n, wo, wi):
    """The unit vector, on the side of n, about which wi mirrors wo, (3, N), and the cosine between it and them (N,)."""
    twice = wo + wi
    # |wo + wi| = 2 wo . h; what is less than rounding has no direction either.
    size = np.maximum(length(twice), np.finfo(twice.dtype).eps)
    return twice * (np.copysign(1, dot(n, twice)).astype(size.dtype, copy=False) / size), 0.5 * size
