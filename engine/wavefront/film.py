"""Where paths leave their light, and pixels gather it."""

import numpy as np

from ..arrays import gather
from .ranks import Ranks
from .replicates import Replicates

BACKGROUND = -1
"""The place in `world.lights` of a world that is the same everywhere: it is not among them."""


class Film:
    """The pixels (P,) of one tile, summed in float64 and in the order of samples, so batches do not change a bit.

    A batch of paths opens it with `open`, adds to it by slots, and closes it with `close`. Between, there are

    radiance  (3, slots), of each path
    clear     (1, slots): the share of each path for which nothing is there
    recorded  {pass: (C, slots)} of those that record something along the way, see `interfaces.Pass`; of "ranks" a list of them
    """

    light = ()
    """What a batch would have brought, and what was taken away of it, where anything is, see `clamping`."""

    def __init__(self, pixels, passes, replicates=(1,), real=np.float32):
        """For `pixels` (P,) whose samples are in `replicates` of such sizes, and of the dtype `real`."""
        self._real = real
        self.passes = passes
        self._parts = tuple(p for p in passes if p.records in ("light", "first hit and light"))
        self._added = tuple(p for p in passes if p in self._parts or getattr(p, "covers", False))
        # One, whatever is asked of them.
        self._replicates = (Replicates(3, pixels, replicates),) if any(p.reduction == "replicates" for p in passes) else ()
        self.sums = {p.key: self._gathering(p, pixels) for p in passes}
        self.samples = np.zeros(pixels, np.int64)
        self._weight = np.zeros(pixels)
        # How many samples were not finite, and of the first of them: the place of its pixel, and its number.
        self.bad_samples, self.first_bad = 0, ()

    def open(self, samples, window, weights=(), first=0):
        """Start `samples` more samples, from number `first` on, of the pixels `window`, a slice or places (M,), each once.

        weights (samples,) is what each counts in the mean, 1 on average over all samples of a pixel; empty: all count 1.
        """
        self._weights = weights
        self._first = first
        self._window = window
        self._count = samples
        slots = samples * self.samples[window].size
        self.radiance = np.zeros((3, slots), self._real)
        self.clear = np.zeros((1, slots), self._real)
        self._slots = slots
        self.recorded = {
            p.key: [] if p.reduction == "ranks" else np.full((_rows(p), slots), p.background, self._real) for p in self.passes if p.records
        }

    def add(self, plan, rays, lanes, L, light, bounces):
        """Add radiance L (3, M) to the paths that `rays` of the indices `lanes` (M,) belong to, each at most once.

        light    the lights that it comes from, (M,) or a number: places in `world.lights`; BACKGROUND, or None: the only one
        bounces  how many surfaces have sent it on
        """
        slot = gather(rays.slot, lanes)
        for row, value in zip(self.radiance, L):
            row[slot] = gather(row, slot) + value
        self.record(plan, rays, lanes, L, light, bounces)

    def record(self, plan, rays, lanes, L, light, bounces):
        """As `add`, for the passes alone: light that the picture does not show."""
        slot = gather(rays.slot, lanes) if self._parts else ()
        for p in self._parts:
            self.recorded[p.key][:, slot] += p.part(plan, rays, lanes, L, light, bounces)

    def meet(self, p, slot, values):
        """Record `values` (C, M) of the pass `p` where the paths of `slot` (M,) have met something first."""
        if p.reduction == "ranks":
            self.recorded[p.key].append(np.zeros((_rows(p), self._slots), np.float32))
            self.recorded[p.key][-1][:, slot] = values
        elif p in self._added:
            self.recorded[p.key][:, slot] += values
        else:
            self.recorded[p.key][:, slot] = values

    def close(self, is_first):
        """Gather the batch into the pixels; `is_first` says that it begins with sample 0."""
        self._drop_bad()
        for replicates in self._replicates:
            radiance = self.radiance.reshape(3, self._count, -1)
            replicates.add(self._window, self._first, radiance * self._weights[:, None] if len(self._weights) else radiance)
        for p in (p for p in self.passes if p.reduction != "replicates"):
            values = self.recorded[p.key] if p.records else p.gather(self)
            if p.reduction == "ranks":
                self._rank(p, values)
                continue
            samples = values.reshape(len(values), self._count, -1)
            if p.reduction == "first":
                self.sums[p.key][:, self._window] += samples[:, 0] if is_first else 0
                continue
            is_weighted = len(self._weights) and p.reduction == "mean"
            total = self.sums[p.key][:, self._window]
            for i in range(self._count):
                # What counts more than once may be beyond float32.
                total += np.multiply(samples[:, i], self._weights[i], dtype=np.float64) if is_weighted else samples[:, i]
            self.sums[p.key][:, self._window] = total
        self.samples[self._window] += self._count
        self._weight[self._window] += sum(self._weights) if len(self._weights) else self._count

    def _drop_bad(self):
        """Not a number or infinite: such a sample is lost, and must not take its pixel with it; so is what only a pass has of it."""
        bad = dark = _not_finite(self.radiance)
        self.radiance[:, dark] = 0
        for p in (p for p in self.passes if p.records and p.reduction != "ranks"):
            values = self.recorded[p.key]
            if p in self._parts:
                values[:, dark] = 0
            lost = _not_finite(values)
            values[:, lost] = 0
            bad = np.union1d(bad, lost) if lost.size else bad
        if bad.size and not self.bad_samples:
            sample, place = divmod(int(bad[0]), self._slots // self._count)
            self.first_bad = int(np.arange(self.samples.size)[self._window][place]), self._first + sample
        self.bad_samples += bad.size

    def _gathering(self, p, pixels):
        """What gathers a pass."""
        if p.reduction == "replicates":
            return self._replicates[0]
        return Ranks(pixels) if p.reduction == "ranks" else np.zeros((_rows(p), pixels))

    def _rank(self, p, layers):
        """Gather what was met, `layers` of (2, slots), in the order of samples, whatever else is in their batch."""
        if layers:
            number, weight = np.stack(layers, axis=1).reshape(2, len(layers), self._count, -1).swapaxes(1, 2)
            weight = weight * np.reshape(self._weights, (-1, 1, 1)) if len(self._weights) else weight
            pixels = np.arange(self.samples.size)[self._window]
            self.sums[p.key].add(pixels, number.reshape(-1, pixels.size), weight.reshape(-1, pixels.size))

    def state(self):
        """{name: array} of all that has been gathered, from which `restore` goes on to the same bits."""
        state = {"samples": self.samples, "weight": self._weight}
        for name, part in self._parts_of_state():
            state |= {f"{name}.{key}": values for key, values in part.state().items()}
        return state | {f"sum.{key}": total for key, total in self.sums.items() if isinstance(total, np.ndarray)}

    def restore(self, state):
        """Go on from the `state` of a film of as many pixels and the same passes. Raises ValueError where it is another's."""
        known = self.state()
        # How much is ranked is not known before.
        kinds = [{key: (v.dtype, v.shape[:-1] if key.startswith("ranks.") else v.shape) for key, v in s.items()} for s in (known, state)]
        if kinds[0] != kinds[1]:
            raise ValueError("it is of another film")
        self.samples, self._weight = state["samples"], state["weight"]
        for name, part in self._parts_of_state():
            part.restore({key: state[f"{name}.{key}"] for key in part.state()})
        self.sums |= {key: state[f"sum.{key}"] for key, total in self.sums.items() if isinstance(total, np.ndarray)}

    def _parts_of_state(self):
        replicates = [("replicates", part) for part in self._replicates]
        return replicates + [(f"ranks.{key}", total) for key, total in self.sums.items() if isinstance(total, Ranks)]

    def pixels(self, is_whole=True):
        """{pass: (C, P) float64} of the samples gathered so far; 0, alpha too, for pixels without any.

        Means are by the number of samples, or where there will be more, `is_whole` is false, by what they weigh so far. Only
        samples from a later one on may begin with those that count negatively, and weigh less than is good to divide by.
        """
        count = np.maximum(self.samples, 1)
        if not is_whole:
            count = np.where(self._weight > 0.5 * count, self._weight, count)
        return {p.key: _reduced(p, self.sums[p.key], count) for p in self.passes}

    def result(self, is_whole=True):
        """`pixels` as they are shown, see `shown`."""
        return shown(self.passes, self.pixels(is_whole))


def _not_finite(values):
    """The slots (M,) of values (C, slots) of which any is not a number or infinite."""
    # All together first, for there is hardly ever one.
    with np.errstate(invalid="ignore"):
        if np.isfinite(values.sum(dtype=np.float64)):
            return np.zeros(0, np.intp)
    return np.nonzero(~np.isfinite(values).all(axis=0))[0]


def _rows(p):
    """How many numbers a pass writes down of each path."""
    return getattr(p, "rows", len(p.channels))


def _reduced(p, total, count):
    if p.reduction == "ranks":
        pairs = total.pairs(p.level)
        pairs[1::2] /= count
        return pairs
    if p.reduction == "replicates":
        return p.of(total)
    return total / (count if p.reduction == "mean" else 1)


def shown(passes, values):
    """{pass: (C, P) float32} of values {pass: (rows, P) float64}: what is a share of something is divided by it, 0 where that is 0."""
    result = {}
    for p in passes:
        value = values[p.key]
        if p.divided_by:
            # By another pass, or by the second half of its own rows.
            value, whole = value[: len(p.channels)], values[p.divided_by][-len(p.channels) :]
            with np.errstate(over="ignore"):
                value = np.divide(value, whole, out=np.zeros_like(value), where=whole != 0)
        result[p.key] = _float32(value)
    return result


def _float32(value):
    """Finite numbers stay finite."""
    with np.errstate(over="ignore"):
        result = value.astype(np.float32)
    if not np.isfinite(result).all():
        beyond = np.isinf(result) & np.isfinite(value)
        result[beyond] = np.copysign(np.finfo(np.float32).max, value[beyond])
    return result
