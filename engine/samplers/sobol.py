"""Owen-scrambled Sobol points: stratified in all elementary intervals at once, so the error of smooth light falls as N^-3/2.

Each dimension has the first two Sobol dimensions, padded: in an order and a scramble of its own for each pixel (Burley
2020, "Practical Hash-based Owen Scrambling", JCGT 9(4)). The scrambles come from a table of _ROWS, computed once; each pixel
and dimension takes one of them at random and flips digits of it, which keeps the scramble uniform and every point uniform.
Powers of two serve it best; other numbers are the beginning of the next one's points.
"""

from functools import lru_cache

import numpy as np

from ..arrays import gather
from ..maths.hashing import mix, mix_int, to_unit
from ..maths.sobol import points
from . import registry

_ROW_BITS = 8
_ROWS = 1 << _ROW_BITS
_LONGEST_ROW = 4096


@registry.add
class Sobol:
    """Owen-scrambled Sobol points: even at every scale, and least noise of all; best with powers of two; the default."""

    key = "sobol"
    label = "Sobol (Owen-scrambled)"

    @staticmethod
    def one(key, sample, dimension, samples):
        h = mix(key ^ mix_int(dimension))
        if samples > _LONGEST_ROW:
            return to_unit(points(sample, h, 1)[0])
        x = gather(_table(samples)[0], _places(h, sample, samples))
        x ^= mix(h)
        return to_unit(x)

    @staticmethod
    def two(key, sample, dimension, samples):
        h = mix(key ^ mix_int(dimension))
        if samples > _LONGEST_ROW:
            return to_unit(points(sample, h))
        place = _places(h, sample, samples)
        x, y = _table(samples)
        pair = np.empty((2, sample.size), np.uint32)
        x.take(place, out=pair[0], mode="wrap")
        y.take(place, out=pair[1], mode="wrap")
        h = mix(h)
        pair[0] ^= h
        h *= np.uint32(0x9E3779B1)
        pair[1] ^= h
        return to_unit(pair)


def _length(samples):
    """The next power of two."""
    return 1 << (samples - 1).bit_length()


def _places(h, sample, samples):
    place = (h >> np.uint32(32 - _ROW_BITS)) * np.uint32(_length(samples))
    place += sample
    return place


def _table(samples):
    return _scrambles(_length(samples))


@lru_cache(maxsize=16)
def _scrambles(length):
    """_ROWS scrambled and shuffled nets of `length` points, one after the other: x, y (_ROWS * length,) uint32."""
    index = np.tile(np.arange(length, dtype=np.uint32), _ROWS)
    return points(index, mix(np.repeat(np.arange(1, _ROWS + 1, dtype=np.uint32), length)))
