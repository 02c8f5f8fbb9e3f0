"""Wavelengths for three channels: what a prism takes apart has to come together as white.

Each channel (linear Rec. 709) is a mean over wavelengths from LOWEST to HIGHEST, weighted by the colour matching functions
of the CIE 1931 observer (as fitted by Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color
Matching Functions", JCGT 2(2)), turned into Rec. 709; what is negative there, colours purer than a display has, is cut
off. Every channel's weights add up to 1, so light that is the same at all wavelengths is white.
"""

import numpy as np

from .discrete import choose, cumulative, probabilities
from .observer import FROM_XYZ

LOWEST, HIGHEST = 400.0, 700.0
"""What is seen of the spectrum [nm]; beyond lies less than 0.1 % of any channel."""
LINE_F, LINE_D, LINE_C = 486.13, 587.56, 656.27
"""Fraunhofer's lines [nm]: blue and red of hydrogen, and between them helium's, where indices of refraction are given."""
_BINS = 60
_WIDTH = (HIGHEST - LOWEST) / _BINS


def place(wavelength):
    """Where `wavelength` [nm] stands in Cauchy's n = A + B / wavelength^2: 0 at the line d, and 1 more at F than at C.

    With the Abbe number V = (n_d - 1) / (n_F - n_C) the index is n = n_d + (n_d - 1) / V * place.
    """
    return (wavelength**-2 - LINE_D**-2) / (LINE_F**-2 - LINE_C**-2)


def _matching(wavelength):
    """The colour matching functions x, y, z (3, N) of wavelengths [nm]."""

    def lobe(peak, below, above):
        return np.exp(-0.5 * ((wavelength - peak) / np.where(wavelength < peak, below, above)) ** 2)

    return np.stack(
        (
            1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
            0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
            1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8),
        )
    )


def _shares():
    """The share of each channel that belongs to each bin, (3, _BINS), and the bins' middles [nm]."""
    middles = LOWEST + _WIDTH * (np.arange(_BINS) + 0.5)
    shares = np.maximum(FROM_XYZ @ _matching(middles), 0)
    return shares / shares.sum(axis=1, keepdims=True), middles


_SHARES, _MIDDLES = _shares()
_CDF = cumulative(_SHARES.sum(axis=0))
_PROBABILITY = probabilities(_CDF)
_WEIGHT = (_SHARES / _PROBABILITY).astype(np.float32)
CHANNELS = ((_SHARES * _MIDDLES**-2.0).sum(axis=1) ** -0.5)[:, None].astype(np.float32)
"""One wavelength (3, 1) [nm] for each channel, where the index is the mean of the channel's: 595, 539 and 450 nm."""


def sample_wavelength(u1):
    """Wavelengths (N,) [nm] in proportion to what the channels see of them, from u1 (N,), and weights (3, N): 0 to 3.

    The mean of the weights is 1 in each channel, and they add up to 3 at every wavelength.
    """
    bins = choose(_CDF, u1)
    within = (u1 - (_CDF - _PROBABILITY).take(bins)) / _PROBABILITY.take(bins)
    return (LOWEST + _WIDTH * (bins + within)).astype(u1.dtype), _WEIGHT.take(bins, axis=1).astype(u1.dtype, copy=False)
