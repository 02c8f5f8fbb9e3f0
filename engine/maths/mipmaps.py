"""Pictures and their mip maps, ready to be looked up at `lookup.Places`.

Between its own texels a picture is interpolated as it is encoded, as Cycles does it. Mip maps average light, never its
encoding: they are linear.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .lookup import Layout

_CODES = 2**16
"""Steps of the table that decodes what is between two bytes: 257 from one to the next."""

_ROWS = 16
"""Of a picture that are decoded at a time."""


@lru_cache(maxsize=4)
def decoding_table(is_srgb, steps=256):
    """(steps,) float32: codes to linear light, by the sRGB curve (IEC 61966-2-1) or in proportion."""
    c = np.arange(steps) / (steps - 1)
    return (np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) if is_srgb else c).astype(np.float32)


@dataclass(frozen=True, slots=True, eq=False)
class Pyramid:
    """A picture and its mip maps, each half as large as the one before, averaged exactly (Williams 1983).

    base    (H * W, 4) texels of level 0: red, green, blue and alpha, bytes as they are encoded, or float32
    coarse  (T, 4) float32, linear: the texels of all further levels one after the other
    is_srgb, is_uncut  how bytes are encoded; whether colours come divided by alpha, as they were before it cut them out
    """

    base: np.ndarray
    coarse: np.ndarray
    layout: Layout
    is_srgb: bool
    is_uncut: bool

    @classmethod
    def of(cls, texels, is_srgb, is_uncut=False):
        """From `texels` (H, W, 4), float32 or, encoded by sRGB or not, uint8."""
        layout = Layout.of(*texels.shape[1::-1])
        levels = []
        while len(levels) + 1 < layout.width.size:
            if levels:
                levels.append(_halved(_halved(levels[-1], 0), 1))
            else:
                # A few rows at a time: the decoded picture need not exist as a whole. Halves of an odd number share a row.
                rows = _ROWS if len(texels) % 2 == 0 else len(texels)
                parts = (texels[start : start + rows] for start in range(0, len(texels), rows))
                levels.append(np.concatenate([_halved(_halved(_decoded(part, is_srgb, is_uncut), 0), 1) for part in parts]))
        coarse = np.concatenate([level.reshape(-1, 4) for level in levels]) if levels else np.zeros((0, 4), np.float32)
        return cls(texels.reshape(-1, 4), coarse, layout, is_srgb, is_uncut)

    def colours(self, places):
        """Linear red, green, blue at `Places`, (3, N)."""
        return places.means(self._lookups(places, self._base_colours, self._coarse_colours, 3))

    def alpha(self, places):
        """Alpha at `Places`, (1, N)."""
        return places.means(self._lookups(places, self._base_alpha, self._coarse_alpha, 1))

    @staticmethod
    def _lookups(places, of_base, of_coarse, channels):
        if places.coarse is None:
            return of_base(places.base)
        if places.base is None:
            return of_coarse(places.coarse)
        result = np.empty((channels, places.count), np.float32)
        for corners, of in ((places.base, of_base), (places.coarse, of_coarse)):
            result[:, corners.lanes] = of(corners)
        return result

    def _base_colours(self, corners):
        texels = _taken(self.base, corners)
        result = _mixed(texels, (0, 1, 2), corners)
        if self.is_uncut:
            _divide(result, _mixed(texels, (3,), corners), 1 if self.base.dtype == np.float32 else 255)
        if self.base.dtype == np.float32:
            return result
        if not self.is_srgb:
            result *= np.float32(1 / 255)
            return result
        # What is no number is black.
        codes = np.fmax(result, 0)
        codes *= 257
        codes += np.float32(0.5)
        return decoding_table(True, _CODES).take(codes.astype(np.int32), mode="clip")

    def _coarse_colours(self, corners):
        texels = _taken(self.coarse, corners)
        result = _mixed(texels, (0, 1, 2), corners)
        if self.is_uncut:
            _divide(result, _mixed(texels, (3,), corners), 1)
        return result

    def _base_alpha(self, corners):
        alpha = _mixed(_taken(self.base, corners), (3,), corners)
        return alpha if self.base.dtype == np.float32 else alpha * np.float32(1 / 255)

    def _coarse_alpha(self, corners):
        return _mixed(_taken(self.coarse, corners), (3,), corners)


def _taken(texels, corners):
    """The texels (K, M, 4) around points. Bytes travel as words of four; to clip costs less than to refuse."""
    if texels.dtype == np.uint8:
        return texels.view(np.uint32)[:, 0].take(corners.index, mode="clip").view(np.uint8).reshape(*corners.index.shape, 4)
    return texels.take(corners.index, axis=0, mode="clip")


def _mixed(texels, channels, corners):
    """The weighted sums (C, M) of some channels of texels (K, M, 4), corner by corner."""
    result = np.empty((len(channels), corners.index.shape[1]), np.float32)
    for channel, total in zip(channels, result):
        parts = texels[..., channel].astype(np.float32)
        if corners.is_whole:
            # What is the same all around stays so to the bit.
            parts[1:] -= parts[0]
            parts[1:] *= corners.weight[1:]
        else:
            parts *= corners.weight
        total[:] = parts[0]
        for part in parts[1:]:
            total += part
    return result


def _divide(colours, alpha, whole):
    """Undo that colours (3, M) are multiplied by alpha (1, M), of which `whole` is all; where nothing is there they stay."""
    colours *= np.where(alpha > 0, whole / np.where(alpha > 0, alpha, 1), 1).astype(np.float32)


def _decoded(texels, is_srgb, is_uncut):
    """Texels (H, W, 4), linear, float32; colours multiplied by alpha, if they are to be divided by it."""
    if texels.dtype == np.float32:
        return texels
    result = decoding_table(False).take(texels)
    if is_srgb and not is_uncut:
        result[..., :3] = decoding_table(True).take(texels[..., :3])
    elif is_srgb:
        code, alpha = np.arange(256), np.maximum(np.arange(256), 1)[:, None]
        straight = decoding_table(True, _CODES).take((code / alpha * (_CODES - 1) + 0.5).astype(np.intp), mode="clip")
        cut = (straight * decoding_table(False)[:, None]).astype(np.float32)
        result[..., :3] = cut.take(texels[..., 3:].astype(np.uint16) * 256 + texels[..., :3])
    return result


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
