"""Choosing one of several, in proportion to given weights."""

import numpy as np

_FEW = 16
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
    """Indices (N,): the i with cdf[i - 1] <= u1 < cdf[i]; a choice of probability 0 is never made."""
    if len(cdf) > _FEW:
        return np.searchsorted(cdf, u1, side="right")
    # For a handful of choices counting beats searching by far.
    index = np.zeros(u1.shape, np.intp)
    for edge in cdf[:-1].astype(u1.dtype):
        index += u1 >= edge
    return index
