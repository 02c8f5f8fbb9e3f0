"""Pixel filters with negative lobes: a fixed share of the samples is drawn from the lobes and counts negatively.

Importance sampling by |f| gives weights of both signs (Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling"). Were
the sign a matter of chance, the weights of a pixel would not add up to 1 and even a white wall would be noisy.
So the samples of each replicate are dealt out: as many to the lobes as is next to their share, spread evenly over the sample
numbers, and the weights of all of them are 1 on average, exactly. Below eight samples there is none to spare for the lobes of
Mitchell's filter; they are left out then.
"""

import numpy as np


def negative_samples(pixel_filter, sizes):
    """Whether each sample of replicates of such `sizes` is drawn from the negative lobes, (samples,) bool; () for a filter without."""
    mass = getattr(pixel_filter, "negative_mass", 0.0)
    if not mass:
        return np.zeros(0, bool)
    return np.concatenate([_dealt(mass, size) for size in sizes])


def sample_weights(pixel_filter, sizes):
    """What each sample of replicates of such `sizes` counts in its pixel, (samples,) float64 with mean 1; () where all count 1."""
    if not np.count_nonzero(negative_samples(pixel_filter, sizes)):
        return np.zeros(0)
    return np.concatenate([_weights(pixel_filter.negative_mass, size) for size in sizes])


def _dealt(mass, samples):
    count = round(samples * mass / (1 + 2 * mass))
    steps = np.arange(samples + 1) * count // samples
    return steps[1:] > steps[:-1]


def _weights(mass, samples):
    negative = _dealt(mass, samples)
    count = np.count_nonzero(negative)
    return np.where(negative, -mass * samples / count, (1 + mass) * samples / (samples - count)) if count else np.ones(samples)


def offsets(pixel_filter, u2, width, negative):
    """Offsets (2, N) [px] for numbers u2 (2, N) of samples that follow each other, `negative` (samples in the batch,) of them."""
    offset = pixel_filter.offset(u2, width)
    if negative.any():
        lobes = np.repeat(negative, u2.shape[1] // negative.size)
        offset[:, lobes] = pixel_filter.negative_offset(u2[:, lobes], width)
    return offset
