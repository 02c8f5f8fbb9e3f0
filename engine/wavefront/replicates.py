"""The error of a pixel, told by replicates: sets of its samples with random numbers of their own.

Samples that are spread evenly depend on each other, so what they differ by says nothing of the error of their mean: it is far
smaller than that of as many independent ones. Sets of them are independent when each is randomised anew, and the means
of sets tell their own variance without bias, whatever the sampler (Owen 1997, "Monte Carlo Variance of Scrambled Net
Quadrature", SIAM J. Numer. Anal. 34(5), section 2; Cranley and Patterson 1976). The price is that the sets do not
complement each other, so they had better be large.
"""

import numpy as np

from .numbers import layout

_STATE = ("samples", "open", "in_open", "count", "closed", "mean", "squares", "known", "variance", "doubt")


class Replicates:
    """What replicates of P pixels say of the mean of all samples; in float64 and in the order of samples.

    The variance of the mean of those of one size is told by what they differ by (they are weighed by their samples, as a range of
    samples may begin within one), and variances of the means of all sizes add up. What is of a replicate that is not complete, or the
    only one of its size, is taken to be as noisy as the rest.
    """

    def __init__(self, channels, pixels, sizes):
        self._ends, self._edges = (frozenset(numbers.tolist()) for numbers in (layout(sizes).ends, layout(sizes).edges))
        self._samples = np.zeros(pixels, np.int64)
        # Of the replicate that is not complete.
        self._open, self._in_open = np.zeros((channels, pixels)), np.zeros(pixels, np.int64)
        # Of the complete ones of its size.
        self._count, self._closed = np.zeros(pixels, np.int64), np.zeros(pixels, np.int64)
        self._mean, self._squares = np.zeros((channels, pixels)), np.zeros((channels, pixels))
        # Of all smaller ones: samples, variance of their sum, and the doubt of that.
        self._known, self._variance, self._doubt = np.zeros(pixels, np.int64), np.zeros((channels, pixels)), np.zeros((channels, pixels))

    def state(self):
        """{name: array} of all that has been added, from which `restore` goes on."""
        return {name: getattr(self, f"_{name}") for name in _STATE}

    def restore(self, state):
        """Go on from a `state`."""
        for name in _STATE:
            setattr(self, f"_{name}", state[name])

    def add(self, window, first, values):
        """Add samples `first` ... of the pixels `window`, a slice or places: values (C, samples, pixels)."""
        for number in range(first, first + values.shape[1]):
            if number in self._edges:
                self._end_size(window)
            self._open[:, window] += values[:, number - first]
            self._in_open[window] += 1
            if number + 1 in self._ends:
                self._close(window)
        self._samples[window] += values.shape[1]

    def standard_error(self):
        """Of the mean of all samples, (C, P); infinite where less than two replicates are complete."""
        known, variance, _ = self._all()
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.sqrt(np.where(known > 0, variance / known / self._samples, np.inf))

    def freedom(self):
        """Degrees of freedom of the standard error, (C, P), 0 where it is unknown (Welch 1947, Satterthwaite 1946)."""
        known, variance, doubt = self._all()
        # Without noise, one is as good as another.
        return np.where(known > 0, np.divide(variance**2, doubt, out=np.ones_like(doubt), where=doubt > 0), 0)

    def _close(self, window):
        # Welford 1962, "Note on a Method for Calculating Corrected Sums of Squares and Products", weighted (West 1979).
        weight = self._in_open[window]
        mean = self._open[:, window] / weight
        self._closed[window] += weight
        self._count[window] += 1
        away = mean - self._mean[:, window]
        self._mean[:, window] += away * (weight / self._closed[window])
        self._squares[:, window] += weight * away * (mean - self._mean[:, window])
        self._open[:, window] = 0
        self._in_open[window] = 0

    def _end_size(self, window):
        known, variance, doubt = self._all(window)
        self._known[window], self._variance[:, window], self._doubt[:, window] = known, variance, doubt
        for numbers in (self._count, self._closed, self._mean, self._squares):
            numbers[..., window] = 0

    def _all(self, window=slice(None)):
        """(samples that it is known of (P,), variance of their sum (C, P), sum of squared variances by degrees of freedom)."""
        freedom, closed = self._count[window] - 1, self._closed[window]
        of_size = np.where(freedom > 0, self._squares[:, window] * closed / np.maximum(freedom, 1), 0)
        known = self._known[window] + np.where(freedom > 0, closed, 0)
        return known, self._variance[:, window] + of_size, self._doubt[:, window] + of_size**2 / np.maximum(freedom, 1)
