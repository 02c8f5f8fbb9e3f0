"""The error of a pixel, told by replicates: sets of its samples with random numbers of their own.

Samples that are spread evenly depend on each other, so what they differ by says nothing of the error of their mean: it is far
smaller than that of as many independent ones. Sets of them are independent when each is randomised anew, and the means
of sets tell their own variance without bias, whatever the sampler (Owen 1997, "Monte Carlo Variance of Scrambled Net
Quadrature", SIAM J. Numer. Anal. 34(5), section 2; Cranley and Patterson 1976). The price is that the sets do not
complement each other.
"""

import numpy as np


class Replicates:
    """What replicates of `size` samples of P pixels say of the mean of all samples; in float64 and in the order of samples.

    The replicates of a pixel are weighed by their samples, for the last one may have less: their variance is then as 1 / samples.
    """

    def __init__(self, channels, pixels, size):
        self._size = size
        self._samples = np.zeros(pixels, np.int64)
        self._open = np.zeros((channels, pixels))
        self._in_open = np.zeros(pixels, np.int64)
        self._closed = np.zeros(pixels, np.int64)
        self.count = np.zeros(pixels, np.int64)
        self._mean = np.zeros((channels, pixels))
        self._squares = np.zeros((channels, pixels))

    def add(self, window, first, values):
        """Add samples `first` ... of the pixels `window`, a slice: values (C, samples, pixels)."""
        for number in range(first, first + values.shape[1]):
            self._open[:, window] += values[:, number - first]
            self._in_open[window] += 1
            if (number + 1) % self._size == 0:
                self._close(window)
        self._samples[window] += values.shape[1]

    def _close(self, window):
        # Welford 1962, "Note on a Method for Calculating Corrected Sums of Squares and Products", weighted (West 1979).
        weight = self._in_open[window]
        mean = self._open[:, window] / weight
        self._closed[window] += weight
        self.count[window] += 1
        away = mean - self._mean[:, window]
        self._mean[:, window] += away * (weight / self._closed[window])
        self._squares[:, window] += weight * away * (mean - self._mean[:, window])
        self._open[:, window] = 0
        self._in_open[window] = 0

    def standard_error(self):
        """Of the mean of all samples, (C, P); infinite where less than two replicates are complete."""
        known = self.count > 1
        with np.errstate(divide="ignore", invalid="ignore"):
            variance = self._squares / (self.count - 1) / self._samples
        return np.sqrt(np.where(known, variance, np.inf))
