"""Looking up pictures: wrapping, nearest and bilinear lookup, and mip maps along a footprint.

Light is averaged, never its encoding: bytes are decoded before they are interpolated or filtered.
Picture coordinates x, y (N,) have their origin at the lower left corner, and 1 is the whole width or height.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

EXTENSIONS = ("repeat", "extend", "clip", "mirror")
"""What is beyond the picture: its copies, its border, black, its reflections."""
MOST_TAPS = 16
"""Lookups along the long axis of a footprint; one that is longer yet is blurred across."""


@lru_cache(maxsize=2)
def decoding_table(is_srgb):
    """(256,) float32: bytes to linear light, by the sRGB curve (IEC 61966-2-1) or as shares of 255."""
    c = np.arange(256) / 255
    return (np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) if is_srgb else c).astype(np.float32)


@dataclass(frozen=True, slots=True, eq=False)
class Pyramid:
    """A picture and its mip maps, each half as large as the one before, averaged exactly (Williams 1983).

    base     (3, H * W) texels of level 0 as they are stored; decode (256,) float32 for bytes, else empty
    coarse   (3, T) float32, linear: the texels of all further levels one after the other
    width, height, start   (L,) intp: of each level its size, and where it begins (levels from 1 on in `coarse`)
    """

    base: np.ndarray
    decode: np.ndarray
    coarse: np.ndarray
    width: np.ndarray
    height: np.ndarray
    start: np.ndarray

    @classmethod
    def of(cls, pixels, is_srgb):
        """From `pixels` (3, H, W), float32 or, encoded by sRGB or not, uint8."""
        is_bytes = pixels.dtype == np.uint8
        decode = decoding_table(is_srgb) if is_bytes else np.zeros(0, np.float32)
        levels, sizes = [], [pixels.shape[1:]]
        while max(sizes[-1]) > 1:
            if levels:
                levels.append(_halved(_halved(levels[-1], 1), 2))
            else:
                # Channel by channel: the decoded picture need not exist as a whole.
                levels.append(np.stack([_halved(_halved(decode.take(c) if is_bytes else c, 0), 1) for c in pixels]))
            sizes.append(levels[-1].shape[1:])
        height, width = np.array(sizes, np.intp).T
        start = np.concatenate(([0], [0], np.cumsum(width[1:] * height[1:])))[: len(sizes)].astype(np.intp)
        coarse = np.concatenate([level.reshape(3, -1) for level in levels], axis=1) if levels else np.zeros((3, 0), np.float32)
        return cls(pixels.reshape(3, -1), decode, coarse, width.copy(), height.copy(), start)

    def nearest(self, x, y, extension):
        """The texel that holds each point, (3, N)."""
        w, h = self.width[0], self.height[0]
        i = np.floor(_inside(x, extension) * np.float32(w)).astype(np.intp)
        j = np.floor(_inside(y, extension) * np.float32(h)).astype(np.intp)
        return _existing(self._texels(np.clip(i, 0, w - 1) + w * np.clip(j, 0, h - 1)), i, w, j, h, extension)

    def bilinear(self, x, y, extension):
        """Between the centres of the four texels around each point, (3, N)."""
        return self._between(self._texels, 0, self.width[0], self.height[0], x, y, extension)

    def filtered(self, x, y, axes, extension, lookup):
        """The mean over footprints: ellipses with half-axes `axes`, two (2, N), long one first; (3, N).

        Where the footprint is smaller than a texel that is `lookup` (`nearest` or `bilinear`). Else trilinear lookups side
        by side along the long axis, of the level on which a texel is as wide as the short one (McCormack et al. 1999,
        "Feline", section 3).
        """
        size = np.array([[self.width[0]], [self.height[0]]], np.float32)
        extent = [2 * np.sqrt(((axis * size) ** 2).sum(axis=0)) for axis in axes]
        swap = extent[1] > extent[0]
        long, short = np.where(swap, extent[1], extent[0]), np.where(swap, extent[0], extent[1])
        long_x, long_y = np.where(swap, axes[1], axes[0])
        result = np.empty((3, x.size), np.float32)
        small = long <= 1
        lanes = np.nonzero(small)[0]
        if lanes.size:
            result[:, lanes] = lookup(x.take(lanes), y.take(lanes), extension)
        short = np.maximum(np.maximum(short, long * np.float32(1 / MOST_TAPS)), 1)
        level = np.log2(short)
        taps = 1
        while taps <= MOST_TAPS:
            # So many that they are at most a texel of their level apart.
            here = ~small & (long <= taps * short)
            if taps > 1:
                here &= long > (taps // 2) * short
            if taps == MOST_TAPS:
                here |= ~small & ~(long <= taps * short)
            lanes = np.nonzero(here)[0]
            if lanes.size:
                px, py, ax, ay, at = (a.take(lanes) for a in (x, y, long_x, long_y, level))
                total = 0
                for tap in range(taps):
                    place = np.float32((2 * tap + 1) / taps - 1)
                    total = total + self._trilinear(px + place * ax, py + place * ay, at, extension)
                result[:, lanes] = total * np.float32(1 / taps)
            taps *= 2
        return result

    def _trilinear(self, x, y, level, extension):
        last = self.width.size - 1
        finer = np.minimum(np.nan_to_num(level).astype(np.intp), last)
        share = np.minimum(level, last) - finer
        a, b = (self._on_level(np.minimum(finer + i, last), x, y, extension) for i in (0, 1))
        return a + share * (b - a)

    def _on_level(self, level, x, y, extension):
        w, h, start = self.width.take(level), self.height.take(level), self.start.take(level)
        lanes = np.nonzero(level == 0)[0]
        if not lanes.size:
            return self._between(self._coarse_texels, start, w, h, x, y, extension)
        if lanes.size == level.size:
            return self._between(self._texels, 0, self.width[0], self.height[0], x, y, extension)
        result = np.empty((3, x.size), np.float32)
        result[:, lanes] = self._between(self._texels, 0, self.width[0], self.height[0], x.take(lanes), y.take(lanes), extension)
        lanes = np.nonzero(level)[0]
        sizes = start.take(lanes), w.take(lanes), h.take(lanes)
        result[:, lanes] = self._between(self._coarse_texels, *sizes, x.take(lanes), y.take(lanes), extension)
        return result

    @staticmethod
    def _between(texels, start, w, h, x, y, extension):
        i0, i1, fx = _neighbours(x, w, extension)
        j0, j1, fy = _neighbours(y, h, extension)

        def along_x(j):
            row = start + w * np.clip(j, 0, h - 1)
            a, b = (_existing(texels(row + np.clip(i, 0, w - 1)), i, w, j, h, extension) for i in (i0, i1))
            b -= a
            b *= fx
            a += b
            return a

        low, high = along_x(j0), along_x(j1)
        high -= low
        high *= fy
        low += high
        return low

    def _texels(self, index):
        texels = self.base.take(index, axis=1)
        return self.decode.take(texels) if self.decode.size else texels

    def _coarse_texels(self, index):
        return self.coarse.take(index, axis=1)


def _inside(x, extension):
    """The place in the picture that stands for coordinates x (N,); where beyond is black, one beyond stays there."""
    if extension == "repeat":
        return x - np.floor(x)
    if extension == "mirror":
        return 1 - np.abs(x - 2 * np.floor(0.5 * x) - 1)
    return np.clip(x, -1, 2) if extension == "clip" else np.clip(x, 0, 1)


def _existing(values, i, w, j, h, extension):
    """`values` (3, N) of the texels i, j (N,), but black for those that a clipped picture lacks."""
    return values * ((i >= 0) & (i < w) & (j >= 0) & (j < h)) if extension == "clip" else values


def _neighbours(x, n, extension):
    """The texels left and right of x among n, an integer or (N,): two indices (N,), and the share (N,) of the second."""
    place = _inside(x, extension) * np.float32(n) if np.ndim(n) == 0 else _inside(x, extension) * n.astype(np.float32)
    place -= np.float32(0.5)
    left = np.floor(place)
    share = place - left
    # What is no number becomes some texel: its share is no number either, so nobody takes it for a colour.
    first = np.fmax(np.fmin(left, 2 * n), -n - 1).astype(np.intp)
    second = first + 1
    if extension == "repeat":
        return np.where(first < 0, first + n, first), np.where(second >= n, 0, second), share
    return first, second, share


def _halved(texels, axis):
    """The mean over each of max(n // 2, 1) equal intervals of n texels, which may cut texels where n is odd."""
    n = texels.shape[axis]
    if n == 1:
        return texels
    texels = np.moveaxis(texels, axis, -1)
    if n % 2 == 0:
        result = 0.5 * (texels[..., 0::2] + texels[..., 1::2])
    else:
        # Of 2 m + 1 texels, interval i begins in texel 2 i and ends in texel 2 i + 2.
        m = n // 2
        i = np.arange(m, dtype=np.float32)
        first, last = (m - i) / n, (i + 1) / n
        result = first * texels[..., 0:-1:2] + np.float32(m / n) * texels[..., 1::2] + last * texels[..., 2::2]
    return np.ascontiguousarray(np.moveaxis(result, -1, axis))
