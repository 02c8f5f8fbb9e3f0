"""Where paths leave their light, and pixels gather it."""

import numpy as np


class Film:
    """The pixels (P,) of one tile, summed in float64 and in the order of samples, so batches do not change a bit.

    A batch of paths opens it with `open`, adds to it by slots, and closes it with `close`.
    """

    def __init__(self, pixels, passes):
        self.passes = passes
        self.sums = {p.key: np.zeros((len(p.channels), pixels)) for p in passes}
        self.samples = np.zeros(pixels, np.int64)
        self.bad_samples = 0

    def open(self, samples, window, weights=()):
        """Start `samples` more samples of the pixels `window`, a slice; further batches open the other pixels.

        weights (samples,) is what each counts in the mean, 1 on average over all samples of a pixel; empty: all count 1.
        """
        self._weights = weights
        self._window = window
        self._count = samples
        slots = samples * (window.stop - window.start)
        self.radiance = np.zeros((3, slots), np.float32)
        self.first_hits = {}
        for p in self.passes:
            if p.at_first_hit:
                self.first_hits[p.key] = np.full((len(p.channels), slots), p.background, np.float32)

    def add(self, slot, L):
        """Add radiance L (3, M) to the paths `slot` (M,), each at most once."""
        for row, value in zip(self.radiance, L):
            row[slot] += value

    def close(self, is_first):
        """Gather the batch into the pixels; `is_first` says that it begins with sample 0."""
        # Not a number or infinite: such a sample is lost, and must not take its pixel with it.
        with np.errstate(invalid="ignore"):
            whole = self.radiance.sum(dtype=np.float64)
        if not np.isfinite(whole):
            bad = ~np.isfinite(self.radiance).all(axis=0)
            self.bad_samples += np.count_nonzero(bad)
            self.radiance[:, bad] = 0
        for p in self.passes:
            values = p.gather(self.radiance, self.first_hits.get(p.key))
            samples = values.reshape(len(values), self._count, -1)
            total = self.sums[p.key][:, self._window]
            if p.reduction == "first":
                total += samples[:, 0] if is_first else 0
                continue
            is_weighted = len(self._weights) and p.reduction == "mean"
            for i in range(self._count):
                total += samples[:, i] * self._weights[i] if is_weighted else samples[:, i]
        self.samples[self._window] += self._count

    def pixels(self):
        """{pass: (C, P) float64} of the samples gathered so far; 0, alpha too, for pixels without any."""
        count = np.maximum(self.samples, 1)
        return {p.key: self.sums[p.key] / (count if p.reduction == "mean" else 1) for p in self.passes}

    def result(self):
        """`pixels` in float32."""
        return {key: values.astype(np.float32) for key, values in self.pixels().items()}
