"""What is computed from pictures and times; pure functions.

Every engine is compared with a long reference of its own, rendered in two halves A and B with noise of their own: the reference is their
mean, and the mean of (A - B)^2 / 4 is what is left of its noise, which is taken off every squared error.
"""

import math
from dataclasses import dataclass

import numpy as np

SIGMAS = 4.0
"""By so many standard deviations of noise may the means of two engines' pictures be apart: once in 16,000 by chance."""
MEAN_TOLERANCE = 0.003
EXCESS_TOLERANCE = 0.03
"""And by so much, over the mean, for what is not noise: float32, the shape of lamps at the borders of pixels."""


@dataclass(frozen=True)
class Reference:
    """The halves (H, W, 3) of a long render and `counts` (H, W), the pixels that count."""

    a: np.ndarray
    b: np.ndarray
    counts: np.ndarray

    @property
    def picture(self):
        """The mean of the halves."""
        return 0.5 * (self.a + self.b)

    @property
    def noise(self):
        """(H, W) its variance, mean of the channels, estimated from the halves."""
        return (0.25 * (self.a - self.b) ** 2).mean(axis=2)

    def squared_error(self, picture):
        """The mean squared error of a `picture` (H, W, 3) over the pixels that count, without the noise of the reference itself."""
        squares = ((picture - self.picture) ** 2).mean(axis=2) - self.noise
        return float(squares[self.counts].mean())

    @property
    def mean(self):
        """Of the pixels that count."""
        return float(self.picture[self.counts].mean())


def agreement(mine, other):
    """How alike two engines' references are: {"ratio", "sigma", "rmse", "excess", "agrees"}.

    ratio   of the means, other / mine
    sigma   its standard deviation by the noise of both, as if pixels were independent
    rmse    between the two, over the mean; noise included
    excess  the part of it that the noise of both does not explain
    """
    counts = mine.counts & other.counts
    noise = (mine.noise + other.noise)[counts]
    mean = mine.picture[counts].mean()
    ratio = other.picture[counts].mean() / mean
    sigma = math.sqrt(noise.sum()) / noise.size / mean
    squares = ((mine.picture - other.picture) ** 2).mean(axis=2)[counts].mean()
    excess = math.sqrt(max(squares - noise.mean(), 0.0)) / mean
    # The noise of the noise: what is squared has about its own size as standard deviation, more where there are fireflies.
    spread = math.sqrt(SIGMAS * math.sqrt((noise**2).mean() / noise.size)) / mean
    agrees = abs(ratio - 1) <= MEAN_TOLERANCE + SIGMAS * sigma and excess <= EXCESS_TOLERANCE + spread
    values = {"ratio": ratio, "sigma": sigma, "rmse": math.sqrt(squares) / mean, "excess": excess}
    return {key: float(value) for key, value in values.items()} | {"agrees": bool(agrees)}


@dataclass(frozen=True)
class Point:
    """An engine at one number of samples: seconds, and the mean squared error of its picture."""

    samples: int
    seconds: float
    error2: float


def equal_error(points, target):
    """The samples and seconds that an engine needs for the mean squared error `target`, (samples, seconds).

    points  two `Point`s. The error is the power of the samples that goes through both, the time the line through both, neither is assumed.
            No picture has less than one sample. (inf, inf) where the error does not fall; NaN where a number is no error
    """
    few, many = sorted(points, key=lambda point: point.samples)
    if not min(few.error2, many.error2, target) > 0:
        return math.nan, math.nan
    power = math.log(many.error2 / few.error2) / math.log(many.samples / few.samples)
    if power >= 0:
        return math.inf, math.inf
    samples = max(many.samples * (target / many.error2) ** (1 / power), 1.0)
    per_sample = (many.seconds - few.seconds) / (many.samples - few.samples)
    return samples, max(many.seconds + per_sample * (samples - many.samples), 0.0)


def busy_share(cpu, wall, threads):
    """How much of `threads` the process got, in [0, 1]: a machine that does other things gives less, and wall times mean less."""
    return min(cpu / (wall * threads), 1.0)
