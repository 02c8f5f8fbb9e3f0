"""Refraction through a rough boundary: a cosine's power about the direction that Snell's law gives.

    f |cos| = k_t / eta^2 (p(wi) + p(wi')),    p(w) = (n + 1) / (2 pi) max(t . w, 0)^n

about the refracted direction t of wo; wi' is wi mirrored at the surface: what would come back is folded to the far side. So
exactly k_t passes, as power; radiance is scaled by 1 / eta^2 (Veach 1997, section 5.2; see Walter et al. 2007 for microfacets),
but see `Dielectric` for `etendue`. Beyond the critical angle t lies along the surface. It is not reciprocal. k_t is meant to be a
texture that knows how much passes towards wo, and eta one that knows the side and the media, `RelativeIndex`.
"""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.fresnel import check_etendue, refracted_cosine
from ..maths.lobes import LARGEST_EXPONENT, check_exponent, sample_lobe, sample_lobe_pdf
from ..maths.vectors import cosine_power, dot, reflect
from . import registry


@registry.add
@dataclass(frozen=True)
class RoughRefraction:
    """f |cos| = k_t etendue / eta^2 (n + 1) / (2 pi) cos^n of the angle to the refracted direction.

    eta  index of refraction of what is on the far side of the viewer over that of what is on the viewer's, > 0
    """

    key = "rough_refraction"
    label = "Rough Refraction"
    is_specular = False
    transmits = True
    is_reciprocal = False
    is_diffuse = False
    limits = {"exponent": (0.0, LARGEST_EXPONENT), "eta": (1e-3, 1e3)}

    transmittance: tuple = (0.8, 0.8, 0.8)
    exponent: float = 32.0
    eta: float = 1.5
    etendue: float = 1.0

    @property
    def ior(self):
        """The index of refraction behind the front of the surface: eta, seen from there."""
        return self.eta

    @classmethod
    def black(cls):
        return cls((0.0, 0.0, 0.0))

    def row(self):
        return {"transmittance": self.transmittance, "exponent": self.exponent, "eta": self.eta, "etendue": self.etendue}

    @staticmethod
    def albedo(k):
        return k.transmittance

    def check(self, owner):
        check_exponent(f"material '{owner}': Phong exponent", self.exponent)
        if not 1e-3 <= self.eta <= 1e3:
            raise SceneError(f"material '{owner}': relative index of refraction is {self.eta}, allowed: 0.001 to 1000")
        check_etendue(owner, self.etendue)

    @staticmethod
    def eval(k, n, wo, wi):
        return RoughRefraction.eval_and_pdf(k, n, wo, wi)[0]

    @staticmethod
    def eval_and_pdf(k, n, wo, wi):
        """See `interfaces.Bsdf`."""
        t, cos = _axis(k, n, wo), np.abs(dot(n, wi))
        pdf = sample_lobe_pdf(t, wi, k.exponent)
        folded = pdf + sample_lobe_pdf(reflect(-t, n), wi, k.exponent)
        return k.transmittance * (folded * k.etendue / (k.eta * k.eta * np.maximum(cos, np.finfo(cos.dtype).tiny))), pdf

    @staticmethod
    def illuminate(k, n, wo, wi):
        return k.transmittance * cosine_power(_axis(k, n, wo), wi, k.exponent)

    @staticmethod
    def sample(k, n, wo, u2):
        return sample_lobe(_axis(k, n, wo), u2, k.exponent)

    @staticmethod
    def pdf(k, n, wo, wi):
        return sample_lobe_pdf(_axis(k, n, wo), wi, k.exponent)


def _axis(k, n, wo):
    """The refracted direction (3, N), also where all is reflected."""
    cos = dot(wo, n)
    along = cos * n - wo
    t = along / k.eta - refracted_cosine(cos, k.eta) * n
    return t / np.sqrt(dot(t, t))
