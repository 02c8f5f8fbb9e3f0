"""When a render ends: with all of its samples, at an error, or at a time, whichever comes first; and what it has reached then."""

import math
import time
from dataclasses import dataclass

import numpy as np

from .wavefront.numbers import layout

MEASURED_BY = ("Combined", "Standard Error")
"""The passes that the error of a picture is taken from."""


@dataclass(frozen=True, slots=True)
class Reached:
    """How far a picture has come.

    samples   of each pixel; some may have more where the time was over
    error     the standard error of the picture relative to its mean, see `relative_error`; infinite where unknown
    ended_by  "samples", "error" or "time": what ended it; "" where it goes on, or was cancelled
    """

    samples: int
    error: float = math.inf
    ended_by: str = ""

    def facts(self):
        """What a file should say of it, {str: str}; the error is a number, 0.01 is 1 %."""
        error = f"{self.error:.6g}" if math.isfinite(self.error) else "not measured"
        return {"samples": str(self.samples), "error": error, "ended_by": self.ended_by or "cancelled"}


NOT_BEGUN = Reached(0)
"""Nothing yet."""


def error_sums(values):
    """(sum of squared standard errors, sum of radiances, how many of them) of pixels {pass: (C, P)}, to be added over tiles."""
    radiance, errors = (values[key][:3].astype(np.float64) for key in MEASURED_BY)
    return np.array((np.square(errors).sum(), radiance.sum(), radiance.size))


def relative_error(sums):
    """The root of the mean squared standard error of all pixels and channels over their mean radiance: an unbiased guess of
    the relative RMSE, from `error_sums` of all tiles. 0 for a picture that is black without a doubt."""
    squares, radiance, count = sums.tolist()
    if not squares:
        return 0.0
    return math.sqrt(squares / count) / abs(radiance / count) if radiance else math.inf


class Ending:
    """Which number of samples the whole frame gets next, and whether it gets any.

    It is asked after every round with what has been reached. Rounds get longer as long as the end is far, so that looking
    costs little, and shorter as it comes near, so that it is not missed by much.
    """

    def __init__(self, settings, ends=()):
        """The clock starts. `ends` are numbers of samples at which to stop by in any case."""
        self._begin, self._end = settings.rendered_samples
        self._ends = ends
        self._target = settings.error_target
        self._limit = settings.time_limit
        self._replicates = layout(settings.replicate_sizes).ends
        self._started = time.monotonic()

    def is_late(self):
        """Whether the time is over."""
        return bool(self._limit) and self._seconds() >= self._limit

    def ended_by(self, samples, error):
        """What ends a frame with so many `samples` and such an `error`; "" for nothing."""
        if samples >= self._end:
            return "samples"
        if self._target and error <= self._target:
            return "error"
        return "time" if self.is_late() and samples > self._begin else ""

    def following(self, samples, error):
        """The number of samples at the end of the round that begins at `samples`."""
        own = (self._end, *(end for end in self._ends if end > samples), *self._for_error(samples, error), *self._for_time(samples))
        return min(own)

    def share(self, done, reached):
        """How much of the work is done, in [0, 1], where it is the share `done` of all samples, and error or time may end it before.

        The last `Reached` forecasts when the error will be small enough.
        """
        needed = self._needed(reached.samples, reached.error) - self._begin if self._target else math.inf
        by_error = done * (self._end - self._begin) / needed if needed else 1.0
        by_time = self._seconds() / self._limit if self._limit else 0.0
        return min(max(done, by_error, by_time), 1.0)

    def _for_error(self, samples, error):
        if not self._target:
            return
        # The end of a replicate: the second one at first, then the last before the error is forecast to be small enough, which is as
        # likely as not a little too early, but not so far away that the forecast is not to be trusted.
        ends = self._replicates[self._replicates > samples]
        if not math.isfinite(error):
            yield int(ends[min(1, ends.size - 1)])
            return
        wanted = min(self._needed(samples, error), self._begin + 2 * (samples - self._begin))
        yield int(ends[max(np.searchsorted(ends, wanted, side="right") - 1, 0)])

    def _for_time(self, samples):
        if not self._limit:
            return
        done = samples - self._begin
        speed = done / max(self._seconds(), 1e-3)
        fits = speed * (self._limit - self._seconds())
        yield samples + max(1, min(done, int(fits / 2)))

    def _needed(self, samples, error):
        # The variance falls as 1 / samples. Nothing is known of an error that is infinite.
        return self._begin + (samples - self._begin) * (error / self._target) ** 2 if math.isfinite(error) else math.inf

    def _seconds(self):
        return time.monotonic() - self._started
