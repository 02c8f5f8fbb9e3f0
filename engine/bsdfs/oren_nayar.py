"""Diffuse reflection of rough surfaces: flatter than Lambert's, and brightest back towards the light (Oren and Nayar 1994).

The form is Fujii's (2012, "A tiny improvement of Oren-Nayar reflectance model") with what is reflected several times added, as in
Portsmouth, Kutz and Hill 2025, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT 14(1), listing 1:

    f = k_d / pi (A (1 + r s / t) + m (1 - E(wo)) (1 - E(wi)) / (1 - <E>)),         A = 1 / (1 + r (1/2 - 2 / (3 pi)))

    s = wi . wo - cos_i cos_o,    t = max(cos_i, cos_o) where s > 0, else 1
    E = A (1 + r G),              pi G = sin (theta - sin cos) + 2/3 (tan (1 - sin^3) - sin)       directional albedo
    <E> = A (1 + r (2/3 - 28 / (15 pi)))                                                           its mean
    m = c^2 <E> / (1 - c (1 - <E>))

m is Blender's, in which what is reflected again is tinted once more than in the paper, whose m has c instead of c^2. For white the
two are one, and all is reflected; c = 0 is Fujii's model. Without roughness A = E = 1, and it is Lambert's.

The differences are written as they are without cancellation: 1 - E = A r (1/2 - 2 / (3 pi) - G), and tan (1 - sin^3) =
sin cos (1 + sin + sin^2) / (1 + sin).
"""

from dataclasses import dataclass

import numpy as np

from ..constants import INV_PI, PI
from ..errors import SceneError
from ..maths.frames import to_world
from ..maths.vectors import dot
from ..maths.warps import square_to_cosine_hemisphere
from . import registry

_RIM = 0.5 - 2 / (3 * PI)
"""G along the surface, where E = 1."""
_MEAN = 2 / 3 - 28 / (15 * PI)
"""The mean of G over all directions, weighted by their cosines."""


@registry.add
@dataclass(frozen=True)
class OrenNayar:
    """Rough diffuse reflection.

    reflectance  k_d, the share of light reflected if `again` is 1
    roughness    r, 0 to 1; 0 is Lambert
    again        c, the colour, 0 to 1, that tints what is reflected several times: usually that of the surface; 0: it is lost
    """

    key = "oren_nayar"
    label = "Oren-Nayar"
    is_specular = False
    transmits = False
    is_reciprocal = True
    is_diffuse = True
    limits = {"roughness": (0.0, 1.0), "again": (0.0, 1.0)}

    reflectance: tuple = (0.8, 0.8, 0.8)
    roughness: float = 0.5
    again: tuple = (0.8, 0.8, 0.8)

    @classmethod
    def black(cls):
        return cls((0.0, 0.0, 0.0))

    def row(self):
        return {"reflectance": self.reflectance, "roughness": self.roughness, "again": self.again}

    @staticmethod
    def albedo(k):
        return k.reflectance

    def check(self, owner):
        if not 0 <= self.roughness <= 1:
            raise SceneError(f"material '{owner}': roughness of Oren-Nayar is {self.roughness}, allowed: 0 to 1")
        if not all(0 <= c <= 1 for c in self.again):
            raise SceneError(f"material '{owner}': colour of further reflections is {self.again}, allowed: three numbers from 0 to 1")

    @staticmethod
    def eval(k, n, wo, wi):
        return k.reflectance * (INV_PI * _shape(k, n, wo, wi))

    @staticmethod
    def illuminate(k, n, wo, wi):
        # The model knows no roughness.
        return k.reflectance * np.maximum(dot(n, wi), 0)

    @staticmethod
    def sample(k, n, wo, u2):
        return to_world(n, square_to_cosine_hemisphere(u2))

    @staticmethod
    def pdf(k, n, wo, wi):
        return np.maximum(dot(n, wi), 0) * INV_PI


def _shape(k, n, wo, wi):
    """pi f / k_d, (3, N)."""
    r, c, cos_o, cos_i = k.roughness, k.again, dot(n, wo), dot(n, wi)
    a = 1 / (1 + r * _RIM)
    s = dot(wi, wo) - cos_i * cos_o
    cos_o, cos_i = np.abs(cos_o), np.abs(cos_i)
    t = np.where(s > 0, np.maximum(np.maximum(cos_i, cos_o), np.finfo(s.dtype).tiny), 1)
    # (1 - E(wo)) (1 - E(wi)) / (1 - <E>), of which A r is cancelled.
    lost = a * r * (_RIM - _rise(cos_o)) * (_RIM - _rise(cos_i)) / (_RIM - _MEAN)
    mean = a * (1 + r * _MEAN)
    return a * (1 + r * s / t) + c * c * (mean / (1 - c * (1 - mean))) * lost


def _rise(cos):
    """G (N,) of cosines (N,) from 0 to 1."""
    cos = np.minimum(cos, 1)
    sin = np.sqrt((1 - cos) * (1 + cos))
    tail = sin * cos * (1 + sin + sin * sin) / (1 + sin) - sin
    return (sin * (np.arctan2(sin, cos) - sin * cos) + 2 / 3 * tail) * INV_PI
