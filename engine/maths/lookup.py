"""Where pictures are looked up: which texels are around points and within footprints, and how much each counts.

That depends on a picture's size alone, so pictures of one size that are looked up at the same points share it.
Picture coordinates x, y (N,) have their origin at the lower left corner, and 1 is the whole width or height.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

EXTENSIONS = ("repeat", "extend", "clip", "mirror")
"""What is beyond the picture: its copies, its border, black, its reflections."""
INTERPOLATIONS = ("closest", "linear", "cubic")
"""Between the texels of the picture itself: nothing, bilinear, cubic B-splines. Between those of mip maps: always bilinear."""
MOST_TAPS = 16
"""Lookups along the long axis of a footprint; one that is longer yet is blurred across."""
_FARTHEST = 1.5
"""Texels between lookups side by side: each is a tent that is two wide, so that nothing falls between them."""


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """The sizes of a picture's levels, each half as large as the one before, and where each begins: (L,) intp each."""

    width: np.ndarray
    height: np.ndarray
    start: np.ndarray

    @staticmethod
    @lru_cache(maxsize=256)
    def of(width, height):
        """Of a picture of W x H texels. Level 0 is an array of its own, the others are in another, one after the other."""
        sizes = [(width, height)]
        while max(sizes[-1]) > 1:
            sizes.append(tuple(max(n // 2, 1) for n in sizes[-1]))
        w, h = np.array(sizes, np.intp).T.copy()
        return Layout(w, h, np.concatenate(([0, 0], np.cumsum(w[1:] * h[1:])))[: w.size].astype(np.intp))


@dataclass(frozen=True, slots=True, eq=False)
class Corners:
    """K texels around each of M lookups: `index` and `weight`, (K, M); which `lanes` (M,) of all lookups, None: all.

    `is_whole`: weights add up to 1, also where the picture ends.
    """

    lanes: object
    index: np.ndarray
    weight: np.ndarray
    is_whole: bool


@dataclass(frozen=True, slots=True, eq=False)
class Places:
    """Where N points are looked up in pictures of one size.

    base, coarse  the `Corners` in level 0, and in those beyond; None where there are none
    count         how many lookups they are
    groups        (points (M,), taps) each: M x taps lookups one after the other, tap by tap; (): one for each point
    """

    base: object
    coarse: object
    count: int
    groups: tuple = ()

    def means(self, values):
        """What `values` (C, count) of the lookups are at the points, (C, N)."""
        if not self.groups:
            return values
        result = np.empty((len(values), sum(points.size for points, _ in self.groups)), np.float32)
        start = 0
        for points, taps in self.groups:
            end = start + taps * points.size
            parts = values[:, start:end].reshape(len(values), taps, points.size)
            # One by one: in which order a sum along an axis is taken depends on the number of lanes.
            result[:, points] = sum(parts[:, tap] for tap in range(taps)) * np.float32(1 / taps)
            start = end
        return result


def places(layout, x, y, axes, extension, interpolation, is_even=None):
    """The `Places` of points x, y (N,) with footprints of half-axes `axes`, two (2, N), or None.

    Where a footprint is smaller than a texel, that is in the picture itself. Else it is side by side along the long axis,
    in the level on which a texel is as wide as the short one (McCormack et al. 1999, "Feline", section 3). Between two
    levels one is chosen by a number that depends on the place alone, so that on average there is no step. Where not `is_even`
    (N,) there is but one lookup: points are here and there, so that the long axis is averaged by their being many.
    """
    if axes is not None:
        # The squares of whole extents in texels, which need no roots.
        width, height = np.float32(2 * layout.width[0]), np.float32(2 * layout.height[0])
        a, b = (np.square(axis[0] * width) + np.square(axis[1] * height) for axis in axes)
        long, short = np.maximum(a, b), np.minimum(a, b)
        if is_even is not None:
            long = np.where(is_even, long, short)
        is_wide = long > 1
    if axes is None or not is_wide.any():
        return Places(_corners(None, x, y, *_whole(layout), extension, interpolation), None, x.size)
    short = np.maximum(np.maximum(short, long * np.float32(MOST_TAPS**-2)), 1)
    columns, groups = _side_by_side((x, y, short, is_wide, _number_of(x, y)), axes, a >= b, long)
    x, y, short, is_wide, u1 = columns
    level = _level(short, u1, layout.width.size - 1) * is_wide
    base, coarse = np.nonzero(level == 0)[0], np.nonzero(level)[0]
    parts = []
    for lanes, how in ((base, interpolation), (coarse, "linear")):
        if not lanes.size:
            parts.append(None)
            continue
        is_all = lanes.size == level.size
        px, py, k = (x, y, level) if is_all else (column.take(lanes) for column in (x, y, level))
        sizes = _whole(layout) if lanes is base else (layout.width.take(k), layout.height.take(k), layout.start.take(k))
        parts.append(_corners(None if is_all else lanes, px, py, *sizes, extension, how))
    return Places(*parts, level.size, groups)


def _side_by_side(columns, axes, is_first, long):
    """The columns x, y, short, is_wide, u1 of all lookups, and their groups; `is_first` says which of `axes` is the long one."""
    _, _, short, is_wide, _ = columns
    with np.errstate(invalid="ignore"):
        ratio = long / short
    # What is no number exceeds nothing.
    taps = sum((ratio > (_FARTHEST * n) ** 2).view(np.int8) for n in _DOUBLINGS) * is_wide
    if not taps.any():
        return columns, ()
    parts, groups = [], []
    for power in range(len(_DOUBLINGS) + 1):
        lanes = np.nonzero(taps == power)[0]
        if not lanes.size:
            continue
        n = 2**power
        own = [column.take(lanes) for column in columns]
        groups.append((lanes, n))
        if n > 1:
            first = is_first.take(lanes)
            along = (np.where(first, axes[0][i].take(lanes), axes[1][i].take(lanes)) for i in (0, 1))
            share = (np.arange(n, dtype=np.float32) / n)[:, None]
            place = 2 * share + np.float32(1 / n - 1)
            own[:2] = ((p + place * step).ravel() for p, step in zip(own, along))
            own[2:4] = (np.tile(column, n) for column in own[2:4])
            # All of a point's numbers are evenly spread, so that its levels nearly are what they are on average.
            own[4] = ((own[4] + share) % 1).ravel()
        parts.append(own)
    return map(np.concatenate, zip(*parts)), tuple(groups)


_DOUBLINGS = [2**power for power in range(MOST_TAPS.bit_length() - 1)]


def _number_of(x, y):
    """A number in [0, 1) for each place x, y (N,), hashed, as neighbours would else be alike."""
    x, y = (side.astype(np.float32, copy=False).view(np.uint32) for side in (x, y))
    bits = x * np.uint32(0x9E3779B1) ^ y * np.uint32(0x85EBCA77)
    bits ^= bits >> np.uint32(15)
    bits *= np.uint32(0xC2B2AE3D)
    bits >>= np.uint32(9)
    bits |= np.uint32(0x3F800000)
    return bits.view(np.float32) - 1


def _level(square, u1, last):
    """The level, at most `last`, on which a texel is as wide as the root of `square` (N,), up or down as u1 in [0, 1) has it."""
    dither = 1 + u1
    # Half of the exponent of a square.
    level = ((square * dither * dither).astype(np.float32, copy=False).view(np.int32) - np.int32(127 << 23)) >> 24
    return np.minimum(level, last)


def _whole(layout):
    return layout.width[0], layout.height[0], 0


def _corners(lanes, x, y, w, h, start, extension, interpolation):
    """The `Corners` of points x, y (M,) in levels of w x h texels that begin at `start`, numbers or (M,)."""
    i, u = _AROUND[interpolation](_inside(x, extension), w, extension)
    j, v = _AROUND[interpolation](_inside(y, extension), h, extension)
    index = np.empty((len(j), len(i), x.size), np.intp)
    for row, rows in zip(index, j):
        row[:] = rows * w + start
    weight = np.empty(index.shape, np.float32)
    for row, share in zip(weight, v):
        for column, each in zip(row, u):
            np.multiply(share, each, out=column)
    for column, columns in enumerate(i):
        index[:, column] += columns
    return Corners(lanes, index.reshape(-1, x.size), weight.reshape(-1, x.size), extension != "clip")


def _inside(x, extension):
    """The place in the picture that stands for coordinates x (N,), or one beyond as far as it can be told from others."""
    if extension == "repeat":
        return x - np.floor(x)
    if extension == "mirror":
        return 1 - np.abs(x - 2 * np.floor(0.5 * x) - 1)
    return np.clip(x, -2, 3)


def _closest(x, n, extension):
    """The texel that holds each place x (N,) among n, a number or (N,): its index, and its weight; each in a list."""
    left = np.floor(x * _single(n))
    if extension in ("repeat", "mirror"):
        # Rounding may end where the next copy begins.
        left = np.minimum(left, _single(n) - 1)
    i, weight = _existing(_whole_numbers(left, n), n, extension, np.ones_like(x))
    return [i], [weight]


def _linear(x, n, extension):
    """The two texels left and right of each place, and their weights."""
    first, share = _left_of(x, n)
    pairs = [_existing(first + k, n, extension, weight) for k, weight in enumerate((1 - share, share))]
    return zip(*pairs)


def _cubic(x, n, extension):
    """The four texels around each place, and the weights of uniform cubic B-splines (de Boor 1978)."""
    first, t = _left_of(x, n)
    s = 1 - t
    weights = s * s * s / 6, (2 / 3) - t * t * (1 - 0.5 * t), (2 / 3) - s * s * (1 - 0.5 * s), t * t * t / 6
    pairs = [_existing(first + k, n, extension, np.float32(1) * weight) for k, weight in enumerate(weights, -1)]
    return zip(*pairs)


_AROUND = {"closest": _closest, "linear": _linear, "cubic": _cubic}


def _single(n):
    return n.astype(np.float32)


def _left_of(x, n):
    place = x * _single(n)
    place -= np.float32(0.5)
    left = np.floor(place)
    place -= left
    return _whole_numbers(left, n), place


def _whole_numbers(a, n):
    # What is no number becomes some texel: its share is no number either, so nobody takes it for a colour.
    return np.fmax(np.fmin(a, _single(n + 1)), -3).astype(np.intp)


def _existing(i, n, extension, weight):
    """Texels i (N,) of n, a little beyond perhaps, as those that stand for them; and the `weight` of these."""
    if extension == "clip":
        weight = weight * ((i >= 0) & (i < n))
    elif extension == "repeat":
        if np.ndim(n) == 0 and n & (n - 1) == 0:
            # Of a power of two the last digits are what is left, below 0 as well.
            return i & (n - 1), weight
        # Twice: of a single texel there are three copies in reach.
        for _ in range(2):
            i = i + n * (i < 0)
            i -= n * (i >= n)
        return i, weight
    elif extension == "mirror":
        i = np.where(i < 0, -1 - i, i)
        i = np.where(i >= n, 2 * n - 1 - i, i)
    return np.minimum(np.maximum(i, 0), n - 1), weight
