"""Glossy reflection of whatever share is wished for, for each direction of view: Phong's lobe, fading towards the horizon.

    f |cos| = k_s p(wi) S(cos_i) / N(cos_o, n),    p(w) = (n + 1) / (2 pi) max(r . w, 0)^n

about the mirror direction r of wo. Below n = 1 the power stays 1, so that there is no edge where r . w = 0, and the axis turns
towards the normal, as the peak of rough surfaces does: at n = 0 it is Lambert's lobe, masked. S is Smith's masking of GGX as
wide as the lobe, 2 c / (c + sqrt(a^2 + (1 - a^2) c^2)) (Walter et al. 2007, eq. 34): without it wide lobes would end at the
horizon of the light in a hard edge. N is what S and the horizon leave of p, worked out beforehand, so that k_s is reflected,
whatever wo; for n -> infinity it is the mirror itself. The price is reciprocity. k_s is meant to be a texture that knows how
much is reflected towards wo.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..maths.ggx import alpha2_of_exponent
from ..maths.lobes import LARGEST_EXPONENT, Highlight, sample_lobe, sample_lobe_pdf
from ..maths.vectors import cosine_power, dot, length, reflect
from ..maths.warps import square_to_cosine_power
from . import registry

_WIDTHS, _COSINES, _SIDE = 69, 33, 56
_NARROW, _KINK = 28, 0.5**0.5
"""So many rows of the table are for lobes narrower than n = 1, where the lobe begins to turn and N has a kink."""
_MARGIN = np.float32(1 + 2.0**-9)
"""So much may N be above what the table says (0.11 % at most, measured); no more must be reflected than k_s."""


@registry.add
@dataclass(frozen=True)
class Gloss(Highlight):
    """k_s times Phong's lobe, masked towards the horizon and scaled up to what is lost; `exponent` n >= 0, large is sharp."""

    key = "gloss"
    label = "Gloss"
    is_reciprocal = False

    @staticmethod
    def eval(k, n, wo, wi):
        return Gloss.eval_and_pdf(k, n, wo, wi)[0]

    @staticmethod
    def eval_and_pdf(k, n, wo, wi):
        """See `interfaces.Bsdf`."""
        pdf, a2 = Gloss.pdf(k, n, wo, wi), alpha2_of_exponent(k.exponent)
        # S / cos, which has a limit at the horizon.
        cos = np.abs(dot(n, wi))
        masked = 2 / (cos + np.sqrt(a2 + (1 - a2) * cos * cos))
        return k.reflectance * (pdf * masked / (_left(k.exponent, np.abs(dot(n, wo))) * _MARGIN)), pdf

    @staticmethod
    def illuminate(k, n, wo, wi):
        return k.reflectance * cosine_power(reflect(wo, n), wi, k.exponent)

    @staticmethod
    def sample(k, n, wo, u2):
        axis, power = _lobe(k.exponent, n, wo)
        return sample_lobe(axis, u2, power)

    @staticmethod
    def pdf(k, n, wo, wi):
        axis, power = _lobe(k.exponent, n, wo)
        return sample_lobe_pdf(axis, wi, power)


def _lobe(exponent, n, wo):
    """The axis (3, N), unit, and the power (N,) of the cosine to it."""
    axis = reflect(wo, n)
    exponents = np.broadcast_to(exponent, axis.shape[1:])
    wide = np.nonzero(exponents < 1)[0]
    if wide.size:
        up = np.broadcast_to(n, axis.shape).take(wide, axis=1)
        turned = up + exponents.take(wide) * (axis.take(wide, axis=1) - up)
        axis[:, wide] = turned / length(turned)
    return axis, np.maximum(exponent, 1)


@lru_cache(maxsize=1)
def _table():
    """N (_WIDTHS, _COSINES) float32, means over the lobe: by its width w = 1 / sqrt(n + 1), and by cos (1 + w) / (cos + w) of wo.

    Both are from 0 to 1. So places near the horizon are told apart as finely as the lobe is narrow.
    """
    # One half of the lobe, the other is its mirror image.
    u2 = (np.stack(np.meshgrid(np.arange(_SIDE), np.arange(_SIDE // 2))).reshape(2, -1) + 0.5) / _SIDE
    table, up, y = np.empty((_WIDTHS, _COSINES)), np.array((0.0, 0.0, 1.0))[:, None], np.linspace(0, 1, _COSINES)
    widths = np.concatenate((np.linspace(0, _KINK, _NARROW + 1), np.linspace(_KINK, 1, _WIDTHS - _NARROW)[1:]))
    for row, width in zip(table, np.maximum(widths, (LARGEST_EXPONENT + 1) ** -0.5)):
        exponent = 1 / width**2 - 1
        a2 = alpha2_of_exponent(exponent)
        cos = np.minimum(width * y / (1 + width - y), 1.0)
        axis, power = _lobe(np.float64(exponent), up, np.stack((-np.sqrt(1 - cos * cos), 0 * cos, cos)))
        # Axes are in the plane of x and z; how far up directions about them are.
        x, _, z = square_to_cosine_power(u2, power)
        c = np.maximum(axis[2][:, None] * z - axis[0][:, None] * x, 0)
        # Where c is 0, so is what is left.
        row[:] = np.mean(2 * c / np.maximum(c + np.sqrt(a2 + (1 - a2) * c * c), np.finfo(float).tiny), axis=1)
    return table.astype(np.float32).ravel()


def _left(exponent, cos):
    """N (N,) of exponents and cosines (N,), linear between the entries of the table."""
    width = 1 / np.sqrt(exponent + 1)
    wider = (width - _KINK) * ((_WIDTHS - 1 - _NARROW) / (1 - _KINK))
    x = np.where(width < _KINK, width * (_NARROW / _KINK), _NARROW + wider).astype(width.dtype)
    y = cos * (1 + width) / (cos + width) * (_COSINES - 1)
    i, j = np.minimum(x.astype(np.intp), _WIDTHS - 2), np.minimum(y.astype(np.intp), _COSINES - 2)
    a, b, table = x - i.astype(x.dtype), y - j.astype(y.dtype), _table()
    first = i * _COSINES + j
    lower = (1 - b) * table.take(first, mode="clip") + b * table.take(first + 1, mode="clip")
    upper = (1 - b) * table.take(first + _COSINES, mode="clip") + b * table.take(first + _COSINES + 1, mode="clip")
    return (1 - a) * lower + a * upper
