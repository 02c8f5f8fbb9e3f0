"""Glossy reflection of whatever share is wished for, for each direction of view: a cosine's power without loss at the rim.

    f |cos| = k_s (p(wi) + p(wi')),    p(w) = (n + 1) / (2 pi) max(r . w, 0)^n

about the mirror direction r of wo, where wi' is wi mirrored at the surface: what would go below it is folded back. So exactly
k_s is reflected, whatever wo, where the lobe of Lafortune and Willems 1994 (CW 197) loses with the cosine; for n -> infinity it
is the mirror itself. The price is reciprocity. k_s is meant to be a texture that knows how much is reflected towards wo.
It is sampled as Phong's lobe is; weights are at most 2 k_s.
"""

from dataclasses import dataclass

import numpy as np

from ..maths.lobes import LARGEST_EXPONENT, check_exponent, sample_lobe, sample_lobe_pdf
from ..maths.vectors import cosine_power, dot, reflect
from . import registry


@registry.add
@dataclass(frozen=True)
class Gloss:
    """f |cos| = k_s (n + 1) / (2 pi) cos^n of the angle to the mirror direction; `exponent` n >= 0, large is sharp."""

    key = "gloss"
    label = "Gloss"
    is_specular = False
    transmits = False
    is_reciprocal = False
    is_diffuse = False
    limits = {"exponent": (0.0, LARGEST_EXPONENT)}

    reflectance: tuple = (0.8, 0.8, 0.8)
    exponent: float = 32.0

    @classmethod
    def black(cls):
        return cls((0.0, 0.0, 0.0))

    def row(self):
        return {"reflectance": self.reflectance, "exponent": self.exponent}

    @staticmethod
    def albedo(k):
        return k.reflectance

    def check(self, owner):
        check_exponent(f"material '{owner}': Phong exponent", self.exponent)

    @staticmethod
    def eval(k, n, wo, wi):
        return k.reflectance * (_folded(k, n, wo, wi) / _cosine(n, wi))

    @staticmethod
    def illuminate(k, n, wo, wi):
        return k.reflectance * cosine_power(reflect(wo, n), wi, k.exponent)

    @staticmethod
    def sample(k, n, wo, u2):
        return sample_lobe(reflect(wo, n), u2, k.exponent)

    @staticmethod
    def pdf(k, n, wo, wi):
        return sample_lobe_pdf(reflect(wo, n), wi, k.exponent)


def _folded(k, n, wo, wi):
    r = reflect(wo, n)
    # Mirrored wi to r is as wi to mirrored r, which is -wo.
    return sample_lobe_pdf(r, wi, k.exponent) + sample_lobe_pdf(-wo, wi, k.exponent)


def _cosine(n, wi):
    cos = np.abs(dot(n, wi))
    return np.maximum(cos, np.finfo(cos.dtype).tiny)
