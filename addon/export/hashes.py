"""Cycles' random numbers of whole numbers and names (Jenkins 2006, "lookup3", final), so that both engines choose alike."""

import numpy as np

_START = 0xDEADBEEF + 13
_MOST = np.float32(0xFFFFFFFF)


def unit_of(*x):
    """A number float32 (N,) in [0, 1] for one or two arrays (N,) of whole numbers."""
    start = np.uint32((_START + (len(x) << 2)) & 0xFFFFFFFF)
    values = [start + np.asarray(column, np.uint32) for column in x] + [np.full(np.shape(x[0]), start)] * (3 - len(x))
    return unit_of_hash(_final(*values))


def unit_of_name(name):
    """A number in [0, 1] for a name."""
    code = 0
    for byte in name.encode():
        code = (37 * code + byte) & 0xFFFFFFFF
    return float(unit_of(np.array([code]), np.zeros(1))[0])


def unit_of_hash(x):
    """A number float32 in [0, 1] for a hash of 32 bits."""
    return np.float32(x) / _MOST


def _final(a, b, c):
    def turned(x, k):
        return (x << np.uint32(k)) | (x >> np.uint32(32 - k))

    c = (c ^ b) - turned(b, 14)
    a = (a ^ c) - turned(c, 11)
    b = (b ^ a) - turned(a, 25)
    c = (c ^ b) - turned(b, 16)
    a = (a ^ c) - turned(c, 4)
    b = (b ^ a) - turned(a, 14)
    return (c ^ b) - turned(b, 24)
