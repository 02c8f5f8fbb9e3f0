"""The first two Sobol dimensions, Owen-scrambled and in random order, by hashing; no tables of direction numbers.

Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4): a scramble of the digits where each is flipped depending on
those above it is a hash of the bit-reversed number that lets bits change higher bits only (Laine and Karras 2011,
"Stratified Sampling for Stochastic Transparency"). Any aligned block of 2^k indices is a (0, k, 2)-net: one point in each
elementary interval of area 2^-k.
"""

import numpy as np

_U = np.uint32


def points(index, key, dimensions=2):
    """The points (dimensions, N) uint32, as fractions of 2^32, of index, key (N,) uint32: one sequence for each key.

    The order is shuffled likewise, so that blocks of 2^k indices stay together, aligned blocks of aligned blocks.
    """
    index = reverse_bits(owen(reverse_bits(index), key))
    pair = np.empty((dimensions, index.size), _U)
    # The first dimension is the index mirrored at the point: mirrored once more it is the index.
    pair[0] = owen(index, key * _U(0x9E3779B1))
    if dimensions > 1:
        pair[1] = owen(_pascal(index), key * _U(0x85EBCA77))
    return reverse_bits(pair)


def owen(x, key):
    """A nested uniform scramble of bit-reversed uint32: bits are flipped depending on key and on all lower bits."""
    # Vegdahl 2021, "Building a Better LK Hash": less biased than the constants of Laine and Karras, of Burley too. Times an
    # even number moves bits up, times an odd one leaves the lowest bit as it is.
    x = x ^ (x * _U(0x3D20ADEA))
    x += key
    x *= (key >> _U(16)) | _U(1)
    x ^= x * _U(0x05526C56)
    x ^= x * _U(0x53A22864)
    return x


def reverse_bits(x):
    """uint32 mirrored: bit i becomes bit 31 - i."""
    x = x.byteswap()
    for shift, mask in ((4, 0x0F0F0F0F), (2, 0x33333333), (1, 0x55555555)):
        high = x >> _U(shift)
        high &= _U(mask)
        x &= _U(mask)
        x <<= _U(shift)
        x |= high
    return x


def _pascal(x):
    """Pascal's triangle modulo 2, the generator matrix of the second dimension, times the bits of x; mirrored as x is.

    Bit r of the result is the sum of the bits c of x of which r is a subset, since binomial(c, r) is odd for just these.
    """
    x = x ^ (x >> _U(16))
    for shift, mask in ((8, 0x00FF00FF), (4, 0x0F0F0F0F), (2, 0x33333333), (1, 0x55555555)):
        high = x >> _U(shift)
        high &= _U(mask)
        x ^= high
    return x
