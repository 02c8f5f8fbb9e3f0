"""Hashes of integers: the only source of randomness. Pure, so a path can be replayed from its indices."""

from functools import lru_cache

import numpy as np

_U = np.uint32


def mix(x):
    """A bijective avalanche hash of uint32 (N,): "lowbias32" of Wellons' hash prospector, bias 0.17 (2018)."""
    x = x ^ (x >> _U(16))
    x *= _U(0x7FEB352D)
    x ^= x >> _U(15)
    x *= _U(0x846CA68B)
    x ^= x >> _U(16)
    return x


def mix_int(x):
    """`mix` of one Python integer, taken modulo 2^32; returns numpy.uint32."""
    x &= 0xFFFFFFFF
    x ^= x >> 16
    x = x * 0x7FEB352D & 0xFFFFFFFF
    x ^= x >> 15
    x = x * 0x846CA68B & 0xFFFFFFFF
    return _U(x ^ (x >> 16))


def to_unit(x):
    """uint32 (N,) to float32 in [0, 1): the upper 24 bits, so that 1 is never reached."""
    # 24 bits fit into int32, whose conversion is the faster one.
    result = (x >> _U(8)).view(np.int32).astype(np.float32)
    result *= np.float32(2.0**-24)
    return result


def to_unit2(x):
    """Two numbers (2, N) float32 in [0, 1) from each hash uint32 (N,).

    The second is the first times the golden ratio modulo 1, a lattice of 2^32 points without visible structure
    (Knuth, TAOCP 3.3.4: multipliers near the golden ratio have a good spectrum in two dimensions).
    """
    pair = np.empty((2, x.size), _U)
    pair[0] = x
    np.multiply(x, _U(0x9E3779B1), out=pair[1])
    return to_unit(pair)


def permute(index, length, key):
    """The place (N,) uint32 of `index` in a random permutation of 0 .. length - 1, one permutation for each key.

    index, key (N,) uint32; length int. Every place is equally likely. Short permutations come from a table of
    _ROWS of them, rotated by the key; long ones are computed.
    """
    if length <= _LONGEST_ROW:
        place = (key >> _U(32 - _ROW_BITS)) * _U(length)
        place += index
        result = _permutations(length).take(place)
    else:
        result = _walk(index, length, key)
    # Without the highest bits the sum cannot wrap around 2^32, where two places would meet.
    result += key & _ROTATION
    # Modulo length; NumPy divides by vectors, but takes remainders one by one.
    result -= result // _U(length) * _U(length)
    return result


_ROW_BITS = 8
_ROWS = 1 << _ROW_BITS
_ROTATION = _U(0xFFFFFFFF >> _ROW_BITS)
_LONGEST_ROW = 1024


@lru_cache(maxsize=16)
def _permutations(length):
    """_ROWS permutations of 0 .. length - 1, one after the other, (_ROWS * length,) uint32."""
    index = np.tile(np.arange(length, dtype=_U), _ROWS)
    return _walk(index, length, mix(np.repeat(np.arange(_ROWS, dtype=_U), length)))


def _walk(index, length, key):
    # Kensler 2013, "Correlated Multi-Jittered Sampling", Pixar TM 13-01, listing 2: a keyed bijection of the next power
    # of two, walked until it falls inside.
    mask = _U((1 << (length - 1).bit_length()) - 1)
    result = _permute_power_of_two(index, mask, key)
    outside = np.nonzero(result >= length)[0]
    while outside.size:
        walked = _permute_power_of_two(result[outside], mask, key[outside])
        result[outside] = walked
        outside = outside[walked >= length]
    return result


def _permute_power_of_two(i, mask, p):
    # The constants are Kensler's; each line is a bijection modulo mask + 1.
    i = i ^ p
    i *= _U(0xE170893D)
    i ^= p >> _U(16)
    i ^= (i & mask) >> _U(4)
    i ^= p >> _U(8)
    i *= _U(0x0929EB3F)
    i ^= p >> _U(23)
    i ^= (i & mask) >> _U(1)
    i *= _U(1) | p >> _U(27)
    i *= _U(0x6935FA69)
    i ^= (i & mask) >> _U(11)
    i *= _U(0x74DCB303)
    i ^= (i & mask) >> _U(2)
    i *= _U(0x9E501CC3)
    i ^= (i & mask) >> _U(2)
    i *= _U(0xC860A3DF)
    i &= mask
    i ^= i >> _U(5)
    return i
