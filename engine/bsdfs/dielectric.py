"""Smooth glass, water, and whatever else reflects and refracts without colour of its own.

The share F of exact Fresnel reflection is reflected, the rest refracted by Snell's law; one of the two is followed,
with probability F. Radiance that is refracted is scaled by 1 / eta^2, since a pencil of rays widens as it leaves the
denser medium (Veach 1997, section 5.2).

Where the index varies over the surface, what is inside still has but one: by that radiance is scaled, whatever the boundary
is like where light passes. Else it would win where it leaves through what is denser than where it came in: in even light a
ball with indices of 1.2 and 2 in turn would look 54 % brighter than what surrounds it.

Without Fresnel the shares are the lecture's constants: k_r is reflected and k_t refracted, and where light is totally
reflected all of it is, k_r + k_t. One of the two is followed, with probability in proportion to the constants (their
sums over the channels). Radiance is scaled all the same: a body looks as it does in the lecture, since what is lost on
the way in is won on the way out.

Dispersion is Cauchy's n = A + B / wavelength^2, through the index n_d that is given and the Abbe number V = (n_d - 1) / (n_F - n_C):
B = (n_d - 1) / (V (1 / F^2 - 1 / C^2)) and A = n_d - B / d^2, with Fraunhofer's lines F, d, C = 486.13, 587.56, 656.27 nm.
"""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.fresnel import check_etendue, fresnel_dielectric, refract
from ..maths.spectrum import HIGHEST, LOWEST, place
from ..maths.vectors import dot, reflect
from . import registry


@registry.add
@dataclass(frozen=True)
class Dielectric:
    """A smooth boundary: Fresnel reflection and refraction.

    ior            index of refraction behind the front of the surface, > 0, over that of the vacuum; where bodies share space,
                   of what is behind it alone, and the boundary is between that and the medium which is really before it
    reflectance    k_r, tint of what is reflected; 1 is physical
    transmittance  k_t, tint of what passes the surface, each time; 1 is physical
    is_fresnel     whether Fresnel's equations share the light; else k_r and k_t themselves are the shares
    etendue        (eta / eta_m)^2 where the media on both sides have the relative index eta_m: radiance that passes is scaled by
                   etendue / eta^2; 1 unless `ior` is a texture that varies
    abbe           Abbe number of what is behind the surface: small numbers spread colours, 64 is crown glass, 30 flint; inf: none do
    """

    key = "dielectric"
    label = "Dielectric"
    is_specular = True
    transmits = True
    limits = {"ior": (1e-3, 1e3)}

    ior: float = 1.5
    reflectance: tuple = (1.0, 1.0, 1.0)
    transmittance: tuple = (1.0, 1.0, 1.0)
    is_fresnel: bool = True
    abbe: float = float("inf")
    etendue: float = 1.0

    @property
    def spread(self):
        """How much more the index is at Fraunhofer's line F than at C."""
        return (self.ior - 1) / self.abbe

    @classmethod
    def black(cls):
        return cls(1.5, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    def row(self):
        return {
            "ior": self.ior,
            "reflectance": self.reflectance,
            "transmittance": self.transmittance,
            "is_fresnel": bool(self.is_fresnel),
            "spread": self.spread,
            "etendue": self.etendue,
        }

    def check(self, owner):
        if not 1e-3 <= self.ior <= 1e3:
            raise SceneError(f"material '{owner}': index of refraction is {self.ior}, allowed: 0.001 to 1000")
        if not self.abbe >= 1:
            raise SceneError(f"material '{owner}': Abbe number is {self.abbe}, allowed: from 1 on, inf for no dispersion")
        if min(self.ior + self.spread * place(end) for end in (LOWEST, HIGHEST)) < 1e-3:
            raise SceneError(
                f"material '{owner}': an index of refraction of {self.ior} with the Abbe number {self.abbe} leaves 0.001 to 1000 "
                f"between {LOWEST:g} and {HIGHEST:g} nm"
            )
        check_etendue(owner, self.etendue)
        for name in ("reflectance", "transmittance"):
            if not all(0 <= c < float("inf") for c in getattr(self, name)):
                raise SceneError(f"material '{owner}': {name} is {getattr(self, name)}, allowed: three finite numbers from 0 on")

    @staticmethod
    def albedo(k):
        return np.where(k.is_fresnel, np.maximum(k.reflectance, k.transmittance), k.reflectance + k.transmittance)

    @staticmethod
    def scatter(k, n, wo, is_front, u1):
        eta = np.where(is_front, k.ior, 1 / k.ior)
        share, k_r, k_t = fresnel_dielectric(dot(wo, n), eta), k.reflectance, k.transmittance
        if not k.is_fresnel.all():
            share, k_r, k_t = _with_constants(k, share)
        is_reflected = u1 < share
        wi = np.where(is_reflected, reflect(wo, n), refract(wo, n, eta))
        return wi, np.where(is_reflected, k_r, k_t * (k.etendue / (eta * eta)))

    @staticmethod
    def branches(k, n, wo, is_front):
        eta = np.where(is_front, k.ior, 1 / k.ior)
        share = fresnel_dielectric(dot(wo, n), eta)
        is_fresnel, is_total = k.is_fresnel > 0, share >= 1
        k_r = np.where(is_fresnel, share * k.reflectance, k.reflectance + is_total * k.transmittance)
        k_t = np.where(is_fresnel, 1 - share, ~is_total) * k.transmittance * (k.etendue / (eta * eta))
        reflected = (reflect(wo, n), k_r)
        if eta.ndim == 1:
            return reflected, (refract(wo, n, eta), k_t)
        # An index for each channel: each goes its own way, but all together with the first where they are the same.
        together = (eta == eta[0]).all(axis=0)
        first = np.arange(3)[:, None] == 0
        return reflected, *((refract(wo, n, eta[c]), k_t * np.where(together, c == 0, np.roll(first, c, axis=0))) for c in range(3))


def _with_constants(k, share):
    """Probability (N,) of reflection, k_r and k_t (3, N) over the probability of each, also where they are constants."""
    k_r, k_t = k.reflectance, k.transmittance
    is_fresnel, is_total = k.is_fresnel > 0, share >= 1
    reflected, refracted = k_r.sum(axis=0), k_t.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        constant = np.where(is_total, 1, reflected / (reflected + refracted))
        k_r = np.where(is_fresnel, k_r, np.where(is_total, k_r + k_t, k_r / constant))
        return np.where(is_fresnel, share, constant), k_r, np.where(is_fresnel, k_t, k_t / (1 - constant))
