"""When a render ends: with all of its samples, at an error, or at a time, whichever comes first; and what it has reached then."""

import math
import time
from dataclasses import dataclass

import numpy as np

from .allotment import allotted
from .scene.settings import REPLICATES
from .wavefront.numbers import layout


@dataclass(frozen=True, slots=True)
class Reached:
    """How far a picture has come.

    samples   of each pixel, on average where an error target has spread them; some may have more where the time was over
    error     that of the picture, see `measured.picture_error`; infinite where unknown
    ended_by  "samples", "error" or "time": what ended it; "" where it goes on, or was cancelled
    clamped   the share of the light that clamping has taken away so far
    scatter   by what share the error that the picture really has may differ from `error`, see `measured.scatter`
    """

    samples: int
    error: float = math.inf
    ended_by: str = ""
    clamped: float = 0.0
    scatter: float = 0.0

    def facts(self):
        """What a file should say of it, {str: str}; the error is a number, 0.01 is 1 %."""
        error = f"{self.error:.6g}" if math.isfinite(self.error) else "not measured"
        told = {"samples": str(self.samples), "error": error, "ended_by": self.ended_by or "cancelled"}
        return told | ({"clamped": f"{self.clamped:.4g}"} if self.clamped else {})


NOT_BEGUN = Reached(0)
"""Nothing yet."""
MISSED, LUCK = 1.05, 2.5
"""The error that a picture really has may be more than so many times the target by luck alone: by that of so many standard deviations."""
LOWEST_AIM = 0.87
"""Where luck decides more, not all of it is made up for: most pictures would be far better than was asked for."""
SLOPES = (0.5, 1.0)
"""How fast errors fall is measured, but not believed to be slower than by chance, or faster than by even samples of what is smooth."""
STEEPEST = 4.0
"""Where samples are spread few of them may lower the error much: those of pixels that have most of it."""


def _joined(parts):
    """(H, W) of what is known of the pixels of all tiles {place: (P,)}."""
    left, top = min(x for x, _, _, _ in parts), min(y for _, y, _, _ in parts)
    right, bottom = max(x + width for x, _, width, _ in parts), max(y + height for _, y, _, height in parts)
    whole = np.zeros((bottom - top, right - left), next(iter(parts.values())).dtype)
    for (x, y, width, height), values in parts.items():
        whole[y - top : y - top + height, x - left : x - left + width] = values.reshape(height, width)
    return whole


def _parted(whole, places):
    """{place: (P,)}: what `_joined` has joined."""
    left, top = min(x for x, _, _, _ in places), min(y for _, y, _, _ in places)
    return {place: whole[y - top : y - top + h, x - left : x - left + w].ravel() for place in places for x, y, w, h in (place,)}


class Ending:
    """Which number of samples the whole frame gets next, and whether it gets any.

    It is asked after every round with what has been reached. Rounds get longer as long as the end is far, so that looking
    costs little, and shorter as it comes near, so that it is not missed by much.
    """

    def __init__(self, settings, ends=(), pace=0.0):
        """The clock starts. `ends` are numbers of samples at which to stop by in any case; `pace` [s], if any, is how long rounds last."""
        self._pace = pace
        self._begin, self._end = settings.rendered_samples
        self._ends = ends
        self._target = settings.error_target
        self._limit = settings.time_limit
        self._replicates = layout(settings.replicate_sizes)
        ends = self._replicates.ends[self._replicates.ends > self._begin]
        may_spread = self._target and settings.adaptive_sampling and ends.size >= REPLICATES
        self._spread_from = int(ends[REPLICATES - 1]) if may_spread else math.inf
        # The last samples and error that were looked at, and the power of the samples that the error falls by: 1/2 for independent ones.
        self._looked, self._slope = (), SLOPES[0]
        self._started = time.monotonic()

    def state(self):
        """{name: number} of what it has learned, and the seconds that it took, from which `restore` goes on."""
        return {"looked": list(self._looked), "slope": self._slope, "seconds": self._seconds()}

    def restore(self, state):
        """Go on from a `state`."""
        self._looked, self._slope = tuple(state["looked"]), state["slope"]
        self._started = time.monotonic() - state["seconds"]

    def is_late(self):
        """Whether the time is over."""
        return bool(self._limit) and self._seconds() >= self._limit

    def mean_samples(self, found):
        """How many samples pixels have on average, rounded down, by what is `Found` of all."""
        return self._begin + int(sum(part.samples.sum() for part in found)) // sum(part.samples.size for part in found)

    def ended_by(self, samples, error, scatter=0.0):
        """What ends a frame with so many `samples` and such an `error`, which luck may have off by `scatter`; "" for nothing."""
        if samples >= self._end:
            return "samples"
        if self._target and error <= self._aim(scatter):
            return "error"
        return "time" if self.is_late() and samples > self._begin else ""

    def following(self, samples, error, scatter=0.0):
        """The number of samples at the end of the round that begins at `samples`, with an `error`: learns how fast that falls."""
        self._look(samples - self._begin, error)
        by_error = self._for_error(samples, error, scatter)
        own = (self._end, *(end for end in self._ends if end > samples), *by_error, *self._for_time(samples))
        # What is saved has to be before any pixel gets more: rounds of tiles that end with them are saved tile by tile.
        paced = self._for_pace(samples) if samples > self._begin else ()
        return min((*own, *paced))

    def goals(self, found, samples):
        """{place: how many samples its pixels are to have} of the round that brings the picture to `samples` a pixel.

        found  {(x, y, width, height) [px]: what is `Found` of a tile, or None} of all tiles
        A number, the same everywhere; or (P,) int, where an error target spreads samples. Places that get none are left out.
        """
        # One of a larger size is less noisy than the smaller ones say: after the second one that is known.
        told = np.append(self._replicates.told, self._end)
        ends = told[told > self._begin] - self._begin
        if not all(part and (self._begin + part.samples >= self._spread_from).all() for part in found.values()):
            return dict.fromkeys(found, samples)
        squares, taken = (_joined({place: getattr(part, name) for place, part in found.items()}) for name in ("squares", "samples"))
        goals = _parted(allotted(squares, taken, samples - self._begin, ends), found)
        return {place: self._begin + goal for place, goal in goals.items() if (goal > found[place].samples).any()}

    def share(self, done, reached):
        """How much of the work is done, in [0, 1], where it is the share `done` of all samples, and error or time may end it before.

        The last `Reached` forecasts when the error will be small enough.
        """
        needed = self._needed(reached.samples, reached.error, reached.scatter) - self._begin if self._target else math.inf
        by_error = done * (self._end - self._begin) / needed if needed else 1.0
        by_time = self._seconds() / self._limit if self._limit else 0.0
        return min(max(done, by_error, by_time), 1.0)

    def _for_error(self, samples, error, scatter):
        if not self._target:
            return
        # The end of a replicate: the second one at first, then the last before the error is forecast to be small enough, which is as
        # likely as not a little too early, but not so far away that the forecast is not to be trusted.
        ends = self._replicates.ends[self._replicates.ends > samples]
        if not math.isfinite(error):
            yield int(ends[min(1, ends.size - 1)])
            return
        needed, most = self._needed(samples, error, scatter), self._begin + 2 * (samples - self._begin)
        if samples >= self._spread_from:
            # Some pixels may get more while others do not, so it can be as near as is worth a look.
            yield min(max(samples + int(0.25 * (needed - samples)), samples + samples // 100), most)
            return
        wanted = min(needed, most)
        yield int(ends[max(np.searchsorted(ends, wanted, side="right") - 1, 0)])

    def _for_time(self, samples):
        if not self._limit:
            return
        done = samples - self._begin
        speed = done / max(self._seconds(), 1e-3)
        fits = speed * (self._limit - self._seconds())
        yield samples + max(1, min(done, int(fits / 2)))

    def _for_pace(self, samples):
        # An error target asks at numbers of samples of its own, or it would depend on how fast the machine is.
        if self._pace and not self._target:
            done = samples - self._begin
            yield samples + max(1, int(done * self._pace / max(self._seconds(), 1e-3)))

    def _look(self, samples, error):
        if not (0 < error < math.inf):
            return
        if self._looked and samples > self._looked[0]:
            slope = math.log(self._looked[1] / error) / math.log(samples / self._looked[0])
            self._slope = min(max(slope, SLOPES[0]), SLOPES[1] if samples + self._begin < self._spread_from else STEEPEST)
        self._looked = samples, error

    def _aim(self, scatter):
        """The error that is to be reached: less than the target where luck may have the true one far above that."""
        return self._target * min(max(MISSED / (1 + LUCK * scatter), LOWEST_AIM), 1.0)

    def _needed(self, samples, error, scatter):
        # Nothing is known of an error that is infinite.
        if not math.isfinite(error):
            return math.inf
        return self._begin + (samples - self._begin) * (error / self._aim(scatter)) ** (1 / self._slope)

    def _seconds(self):
        return time.monotonic() - self._started
