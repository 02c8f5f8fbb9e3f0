"""Hashes of integers: the only source of randomness. Pure, so a path can be replayed from its indices."""

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
    return (x >> _U(8)).astype(np.float32) * np.float32(2.0**-24)


def permute(index, length, key):
    """The place (N,) uint32 of `index` in a random permutation of 0 .. length - 1, one permutation for each key.

    Kensler 2013, "Correlated Multi-Jittered Sampling", Pixar TM 13-01, listing 2: a keyed bijection of the next
    power of two, walked until it falls inside. index, key (N,) uint32; length int.
    """
    if length == 1:
        return np.zeros_like(index)
    mask = _U((1 << (length - 1).bit_length()) - 1)
    result = _permute_power_of_two(index, mask, key)
    outside = np.nonzero(result >= length)[0]
    while outside.size:
        walked = _permute_power_of_two(result[outside], mask, key[outside])
        result[outside] = walked
        outside = outside[walked >= length]
    # Kensler adds a rotation by the key: it evens out what few bits cannot mix.
    result += key % _U(length)
    result -= _U(length) * (result >= length)
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
