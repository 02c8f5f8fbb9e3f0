"""Adaptive supersampling: a pixel is divided in four, and each part again, where colours differ.

Whitted 1980, "An Improved Illumination Model for Shaded Display", CACM 23(6), where it speaks of aliasing. A pixel is a
quadtree of cells, squares of the numbers that a pixel filter is sampled with, so that equal cells weigh the same under
every filter; under the box they are squares of the pixel. Each cell has as many samples as the settings say, with random
numbers of its own. A cell is divided if its colour differs from that of one of the eight beside it, in its pixel or in
the next: those of its size, or larger ones that were not divided. The pixel is the mean of the undivided cells by area.
Whitted compares the corners of a square; here the colours of whole cells are compared, which need no samples on borders.

To look only within the pixel would not do. Beside every cell that a straight edge goes through there are cells on either
side of it that it does not touch, so with a threshold below half of the difference of both colours no such cell is missed,
whatever the random numbers: under the box filter the picture is that of cells of the smallest size everywhere.

What no sample has met is not found: a line thinner than the distance of samples is drawn where it was met and is missing
elsewhere. And as the same samples say whether a cell is divided and what it is worth if it is not, what is left undivided is
a little nearer to what is beside it than the truth: a bias, by less than the threshold (Kirk and Arvo 1991, "Unbiased
Sampling Techniques for Image Synthesis", SIGGRAPH). Cells that were divided are worth what their parts are, which is unbiased.

Every decision depends on the cells around it alone, and those are sampled across the borders of tiles, at most two
cells wide at every level; so tiles, threads and borders do not change a bit.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..constants import ONE_MINUS_EPS32
from ..maths.hashing import mix
from ..registry import PASSES
from .cones import WIDTHS
from .film import shown
from .tiles import Pixels, rectangle

_COLOURS = "Combined"
_MOST_CELLS = 2**21
"""Of the smallest cells in a tile: a limit of memory, 350 MB where all is divided."""
_QUARTERS = ((0, 0), (1, 0), (0, 1), (1, 1))
_AROUND = tuple((x, y) for y in (-1, 0, 1) for x in (-1, 0, 1) if x or y)


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """Parts of pixels, x, y (P,) int counted over the full frame in cells of a `level`, 2^level of them across a pixel."""

    level: int
    x: np.ndarray
    y: np.ndarray

    def part(self, window):
        """Those of `window`, a slice or places."""
        return Cells(self.level, self.x[window], self.y[window])

    @property
    def px(self):
        """The pixels that they are in, (P,)."""
        return self.x >> self.level

    @property
    def py(self):
        """The pixels that they are in, (P,)."""
        return self.y >> self.level

    def keys(self, numbers, width, seed):
        """Those of the pixels, hashed with the number of the cell in its pixel: 1, level by level and row by row."""
        x, y = self._in_pixel()
        number = (1 << 2 * self.level) + (y << self.level) + x
        # Hashed once more, or the cell a of pixel b would be the cell b of pixel a.
        return mix(mix(numbers.keys(self.px, self.py, width, seed)) ^ mix(number.astype(np.uint32)))

    def spread(self, u2):
        """Numbers over the cells' own squares of [0, 1)^2."""
        corner = np.tile(np.stack(self._in_pixel()).astype(np.float32), u2.shape[1] // self.x.size)
        # Rounding may reach 1, which no filter expects.
        return np.minimum((u2 + corner) * np.float32(0.5**self.level), np.float32(ONE_MINUS_EPS32))

    def narrow(self, carried):
        """A cell is so many times narrower than its pixel."""
        for name in WIDTHS:
            if hasattr(carried, name):
                setattr(carried, name, getattr(carried, name) * np.float32(0.5**self.level))

    def _in_pixel(self):
        last = (1 << self.level) - 1
        return self.x & last, self.y & last


class AdaptiveTile:
    """A tile whose pixels are divided where colours differ; offers what `tiles.EvenTile` does.

    `_films` has one film for each level that is complete, `_divided` the cells of each level that were divided, in the
    order of their parts, four each. `_tree` tells each cell of all levels its first part, -1 for none, beside its colour.
    """

    @staticmethod
    def longest_side(settings):
        """So that the smallest cells are not too many to be remembered."""
        return math.isqrt(_MOST_CELLS) >> settings.adaptive_levels

    @staticmethod
    def most_rounds(settings):
        """A round for each level."""
        return settings.adaptive_levels + 1

    def __init__(self, plan, place):
        settings = plan.settings
        self._passes = plan.passes
        self._sampled = plan.passes if PASSES[_COLOURS] in plan.passes else (*plan.passes, PASSES[_COLOURS])
        self._new_film = plan.film
        self._replicates = settings.replicate_sizes
        self._threshold = settings.adaptive_threshold or math.inf
        self._levels = settings.adaptive_levels
        self._frame = settings.width, settings.height
        self._place = place
        # Beyond the tile by a cell at the last level that is divided, and at others by two: one for its own neighbours,
        # and one that a smaller cell may have as a neighbour.
        self._roots = self._grown(place, min(self._levels, 2))
        x, y = rectangle(*self._roots)
        self._pixels = Pixels(x, y)
        self._films = [self._film(x.size)]
        self._divided = []
        self._tree = _Tree(self._roots)

    def rounds(self):
        """Level by level, the larger cells first."""
        x, y = self._pixels.px, self._pixels.py
        yield self._films[0], self._pixels
        for level in range(self._levels):
            self._tree.grow(self._films[level].pixels()[_COLOURS])
            divided = self._to_divide(level, x, y)
            if not divided.size:
                return
            self._tree.divide(divided)
            x, y = (np.stack([2 * z.take(divided) + q for q in side], axis=1).ravel() for z, side in zip((x, y), zip(*_QUARTERS)))
            film = self._film(x.size)
            yield film, Cells(level + 1, x, y)
            self._films.append(film)
            self._divided.append(divided)

    def result(self, is_whole=True):
        """The levels that are complete, or the pixels so far."""
        levels = [film.pixels(is_whole) for film in self._films]
        x, y, width, height = self._roots
        own_x, own_y, own_width, own_height = self._place
        result = {}
        for p in self._passes:
            values = _gathered(p.reduction, [level[p.key] for level in levels], self._divided)
            values = values.reshape(-1, height, width)[:, own_y - y :, own_x - x :][:, :own_height, :own_width]
            result[p.key] = values.reshape(len(values), -1)
        return shown(self._passes, result)

    def state(self):
        """Nothing: it is divided in one go."""
        return {}

    @property
    def samples(self):
        """Those of the undivided pixel, (P,) int, of the tile itself."""
        x, y, width, height = self._roots
        own_x, own_y, own_width, own_height = self._place
        samples = self._films[0].samples.reshape(height, width)
        return samples[own_y - y :, own_x - x :][:own_height, :own_width].ravel()

    def _film(self, cells):
        return self._new_film(cells, self._sampled, self._replicates)

    def _to_divide(self, level, x, y):
        """Which of the cells x, y (P,) of a level differ from those around them, if they matter for the tile."""
        left, top, width, height = self._place
        # Cells around the tile are divided only for the sake of smaller ones in it.
        margin = int(level < self._levels - 1)
        inside = (x >= (left << level) - margin) & (x < (left + width << level) + margin)
        inside &= (y >= (top << level) - margin) & (y < (top + height << level) + margin)
        lanes = np.nonzero(inside)[0]
        x, y = x.take(lanes), y.take(lanes)
        last_x, last_y = ((side << level) - 1 for side in self._frame)
        own = self._tree.colours(level, x, y)
        greatest = np.zeros(lanes.size)
        for dx, dy in _AROUND:
            # Beyond the frame there is nothing; another one beside it is met in its place.
            other = self._tree.colours(level, np.clip(x + dx, 0, last_x), np.clip(y + dy, 0, last_y))
            greatest = np.maximum(greatest, difference(own, other))
        return lanes[greatest > self._threshold]

    def _grown(self, place, margin):
        x, y, width, height = place
        left, top = max(x - margin, 0), max(y - margin, 0)
        right, bottom = min(x + width + margin, self._frame[0]), min(y + height + margin, self._frame[1])
        return left, top, right - left, bottom - top


def difference(a, b):
    """Of two radiances with alpha (4, N), (N,) in [0, 1]: the largest of their channels, as displays show them.

    That is by the square root, which is close to the curve of sRGB, in units of white; above white it is the share of
    the brighter one, so that the edges of what is too bright to be shown are found too. What is negative counts as black.
    """
    a, b = np.sqrt(np.maximum(a, 0)), np.sqrt(np.maximum(b, 0))
    return (np.abs(a - b) / np.maximum(np.maximum(a, b), 1)).max(axis=0)


def _gathered(reduction, levels, divided):
    """What cells hold (C, cells), by level, gathered from the smallest into the pixels (C, P)."""
    if reduction in ("first", "ranks"):
        return levels[0]
    for larger, parts, lanes in zip(levels[-2::-1], levels[:0:-1], divided[::-1]):
        quarters = [parts[:, quarter::4] for quarter in range(4)]
        if reduction == "replicates":
            # Of their mean, as they are independent of each other.
            larger[:, lanes] = np.sqrt(sum(q**2 for q in quarters)) / 4
            continue
        total = sum(quarters)
        larger[:, lanes] = total / 4 if reduction == "mean" else larger[:, lanes] + total
    return levels[0]


class _Tree:
    """The colours of cells of all levels, found by where they are; level 0 is the rectangle `roots` of pixels."""

    def __init__(self, roots):
        self._roots = roots
        self._colours = np.zeros((4, 0))
        self._first_part = np.zeros(0, np.int64)
        self._newest = 0

    def grow(self, colours):
        """Add the next level, colours and alpha (4, M) float64: the parts of what was divided, in order."""
        self._newest = self._first_part.size
        self._colours = np.concatenate((self._colours, colours), axis=1)
        self._first_part = np.concatenate((self._first_part, np.full(colours.shape[1], -1)))

    def divide(self, lanes):
        """Cells `lanes` of the newest level will have the next four parts each."""
        self._first_part[self._newest + lanes] = self._first_part.size + 4 * np.arange(lanes.size)

    def colours(self, level, x, y):
        """(4, N) of the cells x, y (N,) of a level, or of the larger ones that they would be part of."""
        left, top, width, _ = self._roots
        cell = ((y >> level) - top) * width + (x >> level) - left
        for up in range(level - 1, -1, -1):
            first = self._first_part.take(cell)
            quarter = (x >> up & 1) + 2 * (y >> up & 1)
            cell = np.where(first < 0, cell, first + quarter)
        return self._colours.take(cell, axis=1)
