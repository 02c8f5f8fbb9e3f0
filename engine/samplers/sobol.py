"""Owen-scrambled Sobol points: stratified at every scale at once, so the error of smooth light falls as N^-3/2.

What matters most in a path is drawn from one sequence of many axes, the place in the pixel and in the lens, the first two bounces: so
samples complement each other in all of these together. Every further dimension has the first two axes, padded: in an order and a
scramble of its own for each pixel (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4)). The scrambles come from a
table, computed once; each pixel takes one of them at random and flips digits of it, which keeps the scramble uniform and
every point uniform. Powers of two serve it best; other numbers are the beginning of the next one's points.
"""

from functools import lru_cache

import numpy as np

from ..dimensions import Dimension, place
from ..maths.hashing import mix, mix_int, to_unit
from ..maths.sobol import points
from . import registry

_AXES = {
    place(Dimension.FILTER): (0, 1),
    place(Dimension.LIGHT): (2, 3),
    place(Dimension.DIRECTION): (4, 6),
    place(Dimension.LOBE): (10,),
    place(Dimension.LIGHT, 1): (5, 7),
    place(Dimension.DIRECTION, 1): (8, 15),
    place(Dimension.LOBE, 1): (11,),
    place(Dimension.LENS): (9, 14),
    place(Dimension.WAVELENGTH): (12,),
    place(Dimension.TIME): (13,),
}
"""Which dimensions have which axes of the one sequence: pairs that are nearly as even as the first two (where those have one point in
each elementary interval, these have four in every four of them together), and of these the ones that left the least noise in pictures."""
_PADDED = (0, 1)

_SCRAMBLES = 8
"""Tables have 2^8 scrambles."""
_FEWER = 18
"""Or as many as make 2^18 points, where all numbers of a pixel have the same one. Padded ones would be the same too often."""
_LONGEST = 12
"""None is made of scrambles of more than 2^12 points."""


@registry.add
class Sobol:
    """Owen-scrambled Sobol points: even at every scale, and least noise of all; best with powers of two; the default."""

    key = "sobol"
    label = "Sobol (Owen-scrambled)"

    @staticmethod
    def one(key, sample, dimension, samples):
        return to_unit(_points(key, sample, dimension, samples, 1)[0])

    @staticmethod
    def two(key, sample, dimension, samples):
        return to_unit(_points(key, sample, dimension, samples, 2))


def _points(key, sample, dimension, samples, count):
    """Numbers (count, N) uint32, as fractions of 2^32."""
    axes, order, flips = _AXES.get(dimension, ())[:count], key, mix(key ^ mix_int(dimension))
    bits = (samples - 1).bit_length()
    scrambles = min(_SCRAMBLES, _FEWER - bits)
    if len(axes) < count:
        axes, order, flips, scrambles = _PADDED[:count], flips, mix(flips), _SCRAMBLES
    if bits > _LONGEST:
        return points(sample, order, axes)
    index = order >> np.uint32(32 - scrambles) << np.uint32(bits)
    index += sample
    result = np.empty((count, sample.size), np.uint32)
    for row, axis in zip(result, axes, strict=True):
        _table(scrambles, bits, axis).take(index, out=row, mode="wrap")
        row ^= flips
        flips *= np.uint32(0x9E3779B1)
    return result


@lru_cache(maxsize=256)
def _table(scrambles, bits, axis):
    """An axis of 2^scrambles scrambled and shuffled sequences of 2^bits points, one after the other, uint32."""
    scramble, index = np.divmod(np.arange(1 << scrambles + bits, dtype=np.uint32), np.uint32(1 << bits))
    return points(index, mix(scramble + np.uint32(1)), (axis,))[0]
