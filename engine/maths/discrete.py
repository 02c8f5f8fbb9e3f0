"""Choosing one of several, in proportion to given weights."""

from dataclasses import dataclass

import numpy as np

_FEW = 16
_MOST_STEPS = 8
"""From where a guide leads; searching by halves takes as long as about so many."""
_SMALLEST = 2.0**-22


def cumulative(weights):
    """Cumulative distribution (..., M) float64 of non-negative finite weights with a positive sum; it ends in exactly 1.

    Its steps are multiples of 2^-24, as uniform float32 numbers are, so that `probabilities` are exact; what has a
    weight at all has a probability of at least _SMALLEST, or it would be lost instead of being noisy.
    """
    weights = np.asarray(weights, np.float64)
    share = weights / weights.max(axis=-1, keepdims=True)
    share = np.where(weights > 0, np.maximum(share / share.sum(axis=-1, keepdims=True), _SMALLEST), 0)
    cdf = np.ceil(np.cumsum(share / share.sum(axis=-1, keepdims=True), axis=-1) * 2.0**24) * 2.0**-24
    # Trailing weights of 0 must share the final 1, or rounding could choose them.
    trailing = np.argmax(weights[..., ::-1] > 0, axis=-1)
    cdf[np.arange(weights.shape[-1]) >= weights.shape[-1] - 1 - trailing[..., None]] = 1.0
    return cdf


def probabilities(cdf):
    """The probability of each choice, (M,): exactly what `choose` does with the rounded cdf."""
    return np.diff(cdf, prepend=0.0)


def choose(cdf, u1):
    """Indices (N,): the i with cdf[i - 1] <= u1 < cdf[i]; a choice of probability 0 is never made. Any of them for what is no number."""
    if len(cdf) > _FEW:
        return _searched(cdf, u1)
    # For a handful of choices counting beats searching by far.
    index = np.zeros(u1.shape, np.intp)
    for edge in cdf[:-1].astype(u1.dtype):
        index += u1 >= edge
    return index


def _searched(cdf, u1):
    # What is no number is beyond all others.
    return np.minimum(np.searchsorted(cdf, u1, side="right"), len(cdf) - 1)


@dataclass(frozen=True, slots=True, eq=False)
class Guide:
    """What finds the choices of a cumulative distribution in a few steps (Chen and Asau 1974, "On Generating Random Variates from
    an Empirical Distribution"): where in it each of K equal parts of [0, 1) begins.

    cdf    (M,) float64, as of `cumulative`
    start  (K,) intp, K a power of two
    steps  how many steps it takes from there at most
    """

    cdf: np.ndarray
    start: np.ndarray
    steps: int

    @classmethod
    def of(cls, cdf):
        """The guide of a distribution."""
        count = 4 << (len(cdf) - 1).bit_length()
        start = np.searchsorted(cdf, np.arange(count) / count, side="right")
        return cls(cdf, start, int(np.diff(start, append=len(cdf) - 1).max()))

    def choose(self, u1):
        """What `choose` finds for u1 (N,) float64."""
        if self.steps > _MOST_STEPS:
            return _searched(self.cdf, u1)
        index = self.start.take((u1 * self.start.size).astype(np.intp), mode="clip")
        for _ in range(self.steps):
            index += self.cdf.take(index, mode="clip") <= u1
        return index
