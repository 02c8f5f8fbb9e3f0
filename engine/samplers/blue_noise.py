"""Sobol points handed out to pixels along a curve, so that neighbours complement each other: the error is blue noise.

Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels",
ACM TOG 39(6): pixels are numbered along a Z curve whose quads are shuffled at every level, for each dimension otherwise,
and each takes the next samples of one Owen-scrambled sequence. The pixels of every aligned square of 2^k then have a
well-spread set in common: where one is too bright the next is too dark, and the eye, or any blur, averages them. A pixel
by itself has as good a set as from the Sobol sampler. Shuffle and scramble are the hashes of `maths.sobol`, which swap the
halves of each level; half of the quads have x and y swapped (16 of the 24 orders). The curve fills blocks of _SIDE x _SIDE
pixels; each has its own sequence.
"""

import numpy as np

from ..maths.hashing import mix, mix_int, to_unit
from ..maths.sobol import points
from . import registry

_BITS = 16
_SIDE = 1 << _BITS // 2


@registry.add
class BlueNoise:
    """Sobol points spread over neighbouring pixels too: with few samples the noise is as fine and even as it can be."""

    key = "blue_noise"
    label = "Blue Noise"

    @staticmethod
    def pixel_key(px, py, width, seed):
        """The number of a pixel along the curve in the lower _BITS, a hash of its block and the seed above."""
        block = mix((py // _SIDE * width + px // _SIDE).astype(np.uint32) ^ mix_int(seed))
        block &= np.uint32(2**32 - 2**_BITS)
        place = _every_other_bit(px % _SIDE) | _every_other_bit(py % _SIDE) << np.uint32(1)
        return block | _turned(place, block)

    @staticmethod
    def one(key, sample, dimension, samples):
        return to_unit(_points(key, sample, dimension, samples, (0,))[0])

    @staticmethod
    def two(key, sample, dimension, samples):
        return to_unit(_points(key, sample, dimension, samples, (0, 1)))


def _points(key, sample, dimension, samples, axes):
    # As many samples as there are bits for; a curve too long for the rest is cut into shorter ones.
    sample_bits = (samples - 1).bit_length()
    curve_bits = np.uint32(min(_BITS, 32 - sample_bits))
    sequence = mix((key >> curve_bits) ^ mix_int(dimension))
    # The block leaves at the upper end where there are fewer bits; else it numbers sequences as well as the hash does.
    index = key << np.uint32(sample_bits)
    index |= sample
    return points(index, sequence, axes)


def _turned(place, block):
    """`place` (N,) along the curve, with x and y swapped in every other quad of each level, at random.

    Halves are complementary first of all; were they always left and right, the noise would stand in upright lines.
    """
    result = place.copy()
    for low in range(0, _BITS, 2):
        quad = mix((place >> np.uint32(low + 2)) ^ block ^ mix_int(low))
        differ = (place >> np.uint32(low) ^ place >> np.uint32(low + 1)) & quad & np.uint32(1)
        result ^= differ * np.uint32(3 << low)
    return result


def _every_other_bit(x):
    """Bits 0 .. 7 of x (N,) moved to the places 0, 2 .. 14, uint32."""
    x = x.astype(np.uint32)
    for shift, mask in ((4, 0x0F0F), (2, 0x3333), (1, 0x5555)):
        x = (x | x << np.uint32(shift)) & np.uint32(mask)
    return x
