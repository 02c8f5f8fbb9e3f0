"""Vectors as rows: every array is (3, N), or (3, 1) to broadcast."""

import numpy as np

from ..constants import ONE_MINUS_EPS32


def as_vector(a):
    """A number (1, N) as three equal ones, (3, N); a vector (3, N) as it is."""
    return np.broadcast_to(a, (3, a.shape[1]))


def dot(a, b):
    """Scalar product, (N,)."""
    result = a[0] * b[0]
    result += a[1] * b[1]
    result += a[2] * b[2]
    return result


def cross(a, b):
    """Vector product, (3, N)."""
    return np.stack((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def length(a):
    """Euclidean length, (N,)."""
    return np.sqrt(dot(a, a))


def normalize(a):
    """Unit vectors along `a`; a zero vector stays zero."""
    return a / np.maximum(length(a), np.finfo(a.dtype).tiny)


def reflect(w, n):
    """The mirror direction of w about n, both leaving the surface: 2 (w . n) n - w."""
    return (2 * dot(w, n)) * n - w


def cosine_power(a, b, exponent):
    """max(a . b, 0)^exponent of unit vectors, also where the exponent is 1e6 and float32 cannot hold the cosine.

    With q = |a - b|^2 / 2 = 1 - a . b the power is exp(exponent * log1p(-q)), and q keeps its digits near 0.
    """
    difference = a - b
    q = dot(difference, difference)
    q *= 0.5
    inside = q < 1
    # Below 1 also where it does not count, or 0 * log(0) would make a NaN of exponent 0.
    np.minimum(q, ONE_MINUS_EPS32, out=q)
    return np.exp(exponent * np.log1p(-q)) * inside
