"""Sobol's sequence, Owen-scrambled and in random order, by hashing.

Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4): a scramble of the digits where each is flipped depending on
those above it is a hash of the bit-reversed number that lets bits change higher bits only (Laine and Karras 2011,
"Stratified Sampling for Stochastic Transparency"). Any aligned block of 2^k indices has one point in each interval of 2^-k of
every axis; of the first two axes it is a (0, k, 2)-net: one point in each elementary interval of area 2^-k.
"""

from functools import lru_cache

import numpy as np

_U = np.uint32

_POLYNOMIALS = (
    (0, (1,)),
    (1, (1, 3)),
    (1, (1, 3, 1)),
    (2, (1, 1, 1)),
    (1, (1, 1, 3, 3)),
    (4, (1, 3, 5, 13)),
    (2, (1, 1, 5, 5, 17)),
    (4, (1, 1, 5, 5, 5)),
    (7, (1, 1, 7, 11, 19)),
    (11, (1, 1, 5, 1, 1)),
    (13, (1, 1, 1, 3, 11)),
    (14, (1, 3, 5, 5, 31)),
    (1, (1, 3, 3, 9, 7, 49)),
    (13, (1, 1, 1, 15, 21, 21)),
    (16, (1, 3, 1, 13, 27, 49)),
)
"""Of each axis but the first: the inner coefficients of its primitive polynomial, highest first, and its first m_k: the
direction numbers of Joe and Kuo 2008, "Constructing Sobol Sequences with Better Two-Dimensional Projections", SIAM J. Sci. Comput.
30(5), whose pairs of axes are spread evenly too."""

AXES = 1 + len(_POLYNOMIALS)
"""How many axes there are."""


def points(index, key, axes=(0, 1)):
    """The points (len(axes), N) uint32, as fractions of 2^32, of index, key (N,) uint32: one sequence for each key.

    `axes` are some of 0 .. AXES - 1: what is drawn for others with the same index and key complements them. The order is shuffled
    likewise, so that blocks of 2^k indices stay together, aligned blocks of aligned blocks.
    """
    index = reverse_bits(owen(reverse_bits(index), key))
    result = np.empty((len(axes), index.size), _U)
    for row, axis in zip(result, axes, strict=True):
        row[:] = owen(_mirrored(index, axis), key * _KEYS[axis])
    return reverse_bits(result)


_KEYS = _U(0x9E3779B1) * np.arange(1, 2 * AXES, 2, dtype=_U)
"""Odd numbers: each makes a key of its own for its axis."""


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


def _mirrored(index, axis):
    """The coordinates (N,) uint32 of Sobol's points along an axis, bit-reversed, before any scramble."""
    if axis == 0:
        # The first coordinate is the index mirrored at the point.
        return index
    lowest, *others = _products(axis)
    x = lowest.take(index & _U(0xFF))
    for place, products in enumerate(others, 1):
        x ^= products.take(index >> _U(8 * place) & _U(0xFF))
    return x


@lru_cache(maxsize=AXES)
def _products(axis):
    """What each of the four bytes of an index, the lowest first, adds to `_mirrored`: (4, 256) uint32."""
    directions = reverse_bits(np.array(_directions(*_POLYNOMIALS[axis - 1]), _U))
    byte, products = np.arange(256), np.zeros((4, 256), _U)
    for bit, direction in enumerate(directions):
        products[bit // 8] ^= np.where(byte >> bit % 8 & 1, direction, _U(0))
    return products


def _directions(coefficients, first):
    """The 32 direction numbers, as fractions of 2^32, by the recurrence of a primitive polynomial (Joe and Kuo 2008, equation 3)."""
    m, degree = list(first), len(first)
    for k in range(degree, 32):
        number = m[k - degree] ^ m[k - degree] << degree
        for j in range(1, degree):
            if coefficients >> degree - 1 - j & 1:
                number ^= m[k - j] << j
        m.append(number)
    return [number << 31 - k for k, number in enumerate(m)]
