"""What is sampled of a tile, and in which order: here all of its pixels alike, in `adaptive` some more than others."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Pixels:
    """Whole pixels, px, py (P,) int in the full frame, as something to send camera rays through."""

    px: np.ndarray
    py: np.ndarray

    def part(self, window):
        """Those of `window`, a slice or places."""
        return Pixels(self.px[window], self.py[window])

    def keys(self, numbers, width, seed):
        """What the random numbers of a `seed` know each by, (P,) uint32, in a frame `width` [px] wide."""
        return numbers.keys(self.px, self.py, width, seed)

    def spread(self, u2):
        """Numbers u2 (2, S * P) in [0, 1) over the filter of a pixel, as numbers over what is to be sampled of it."""
        return u2

    def narrow(self, carried):
        """Make the cones that rays carry as narrow as what is to be sampled of a pixel."""


class EvenTile:
    """All pixels of a tile get the same number of samples.

    Tiles have longest_side(settings) [px], which they may not exceed, and most_rounds(settings). `rounds()` yields
    (film, what to sample into it) one after the other, and goes on when that has been done; `result(is_whole)` at any
    time is {pass: (C, P) float32} of what has been sampled so far, see `Film.pixels`; `samples` (P,) those that count for the error.
    What `state()` tells, {} for nothing, another one of the same place goes on from after `restore(state)`.
    """

    @staticmethod
    def longest_side(settings):
        """No limit of its own."""
        return max(settings.width, settings.height)

    @staticmethod
    def most_rounds(settings):
        """One round is all."""
        return 1

    def __init__(self, plan, place):
        self._pixels = Pixels(*rectangle(*place))
        self._film = plan.film(self._pixels.px.size, plan.passes, plan.settings.replicate_sizes)

    def rounds(self):
        """All pixels in one round."""
        yield self._film, self._pixels

    def result(self, is_whole=True):
        """What the film says."""
        return self._film.result(is_whole)

    def state(self):
        """{name: array} of what has been sampled, see `Film.state`."""
        return self._film.state()

    def restore(self, state):
        """Go on from the `state` of such a tile. Raises ValueError where it is another's."""
        self._film.restore(state)

    @property
    def samples(self):
        """How many each pixel has so far, (P,) int."""
        return self._film.samples.copy()


def rectangle(x, y, width, height):
    """x, y (width * height,) of all places of a rectangle, row by row."""
    row, column = np.divmod(np.arange(width * height), width)
    return column + x, row + y
