"""What the threads of one render share."""

import math
import threading
from contextlib import contextmanager

import numpy as np

from .ending import Reached
from .errors import SceneError, SceneWarning
from .measured import Found, picture_error, scatter
from .saved import Saved


class Work:
    """What the threads of one render share.

    tiles   those that are begun, by their place
    done_with  {place: {pass: (C, P) float32}} of those that are finished, where a checkpoint keeps them
    found   what is `Found` of all, by their place, or None
    measure how errors are measured, one of `MEASURES`
    is_cut  whether the time was over before a round was
    together  how many batches are on a film at a time, see `pace`
    """

    def __init__(self, tiles, ending, measure, cancelled=None, keeps=False):
        self.keeps = keeps
        self.together = 1
        self.ending = ending
        self.measure = measure
        self.found = dict.fromkeys(tiles)
        self.is_cut = False
        self._stops = [threading.Event(), *((cancelled,) if cancelled else ())]
        self.tiles = {}
        self.done_with = {}
        self._lock = threading.Lock()
        self._pixels = sum(width * height for _, _, width, height in tiles)
        self._finished = {}
        self._bad_samples = {}
        self._light = (0.0, 0.0)
        self._warnings, self._told = [], set()
        self._unfinished = []
        self._places = {}

    @contextmanager
    def at(self, place):
        """Say that a thread is at `place` while the block lasts."""
        with self._lock:
            self._places[place] = True
        try:
            yield
        finally:
            with self._lock:
                del self._places[place]

    @property
    def places(self):
        """Where threads are just now."""
        with self._lock:
            return tuple(self._places)

    def stop(self):
        """Let all threads give up."""
        self._stops[0].set()

    def is_stopped(self):
        """Whether the threads are to give up."""
        return any(event.is_set() for event in self._stops)

    def reached(self, before, samples):
        """How far the frame is after a round from the samples `before` it to `samples`; not all pixels got there if it is late."""
        found = tuple(self.found.values())
        is_known = None not in found
        error, luck = (picture_error(found, self.measure), scatter(found)) if is_known else (math.inf, 0.0)
        if self.is_cut or self.is_stopped():
            return Reached(before, error, "time" if self.is_cut else "", self.clamped, luck)
        mean = self.ending.mean_samples(found) if is_known else samples
        return Reached(mean, error, self.ending.ended_by(mean, error, luck), self.clamped, luck)

    def saved(self, reached, has_tiles):
        """The `Saved` of a frame that is as far as `reached`: with what is begun, between rounds; else with finished tiles alone."""
        with self._lock:
            bad, light, done_with = dict(self._bad_samples), self._light, dict(self.done_with)
        tiles = {place: tile.state() for place, tile in self.tiles.items()} if has_tiles else {}
        return Saved(reached, self.ending.state(), bad, light, tiles, done_with)

    def restore(self, saved, plan):
        """Go on from a `Saved`: `Reached`. Raises SceneError where it is of another plan, or damaged."""
        if not (saved.tiles or saved.finished):
            return Reached(plan.settings.rendered_samples[0])
        try:
            self._restore(saved, plan)
        except (KeyError, TypeError, ValueError) as error:
            raise SceneError(f"the checkpoint does not fit what is rendered ({error}); delete it to begin anew") from None
        return saved.reached

    def _restore(self, saved, plan):
        if not saved.tiles.keys() | saved.finished.keys() <= self.found.keys():
            raise ValueError("it is of other tiles")
        for (_, _, width, height), values in saved.finished.items():
            if not set(plan.settings.passes) <= values.keys() or {v.shape[-1] for v in values.values()} != {width * height}:
                raise ValueError("it has other passes, or tiles of another size")
        self.ending.restore(saved.ending)
        self._bad_samples = dict(saved.bad)
        self._light = saved.light
        self.done_with = dict(saved.finished)
        first, end = plan.settings.rendered_samples
        for place, state in saved.tiles.items():
            self.tiles[place] = plan.tile(plan, place)
            self.tiles[place].restore(state)
            if plan.settings.is_measured:
                self.found[place] = Found.of(self.tiles[place].result(is_whole=False), self.tiles[place].samples, self.measure)
            self.finish(place, self.tiles[place].samples.sum() / (place[2] * place[3] * (end - first)))
        for place, values in saved.finished.items():
            if plan.settings.is_measured:
                self.found[place] = Found.of(values, np.full(place[2] * place[3], end - first), self.measure)
            self.finish(place, 1)

    def pace(self, seconds, most_seconds, most):
        """Have as many batches together as take less than `most_seconds`, and `most` at most: those that were took `seconds`."""
        if seconds > most_seconds:
            self.together = max(1, self.together // 2)
        elif 2 * seconds < most_seconds:
            self.together = min(most, 2 * self.together)

    def finish(self, tile, share):
        """The `share` of the work on a tile that is done, in [0, 1]."""
        _, _, width, height = tile
        with self._lock:
            self._finished[tile] = share * width * height

    def show(self, tile):
        """Have an unfinished `Tile` shown."""
        with self._lock:
            self._unfinished.append(tile)

    def take_unfinished(self):
        """The tiles to show since the last time."""
        with self._lock:
            tiles, self._unfinished = self._unfinished, []
        return tiles

    def warn(self, line):
        """Tell a `SceneWarning`, once."""
        with self._lock:
            if line not in self._told:
                self._told.add(line)
                self._warnings.append(line)

    def report_bad(self, count, name, pixel):
        """Say that `count` samples were not finite, the first in a `pixel` (x, y) where it met the object of this `name`; "": none."""
        line = f"samples are not finite and count as black, such as of the pixel {pixel} from the top left"
        with self._lock:
            if name not in self._bad_samples:
                kind = "object" if name else ""
                self._warnings.append(SceneWarning(line if name else f"{line}, where their light adds up", kind, name, is_lost=True))
            self._bad_samples[name] = self._bad_samples.get(name, 0) + count

    def count_light(self, whole=0.0, removed=0.0):
        """Count light that there would be, and what clamping has taken away of it."""
        with self._lock:
            self._light = self._light[0] + whole, self._light[1] + removed

    @property
    def clamped(self):
        """The share of the light that clamping has taken away."""
        with self._lock:
            whole, removed = self._light
        return removed / whole if removed and whole else 0.0

    def lost_in_all(self):
        """Warnings that say how many samples were not finite, and how much light was clamped, if there were any."""
        with self._lock:
            count = sum(self._bad_samples.values())
        if count:
            yield SceneWarning(f"{count} samples in all were not finite and count as black")
        if share := self.clamped:
            yield SceneWarning(f"clamping has taken away {100 * share:.2g} % of the light: the picture is darker than the scene by so much")

    @property
    def done(self):
        """The share of all work that is done, in [0, 1]."""
        with self._lock:
            return sum(self._finished.values()) / self._pixels

    def take_warnings(self):
        """What came up since the last time."""
        with self._lock:
            warnings, self._warnings = self._warnings, []
        return tuple(warnings)
