"""Hashes with which Blender makes patterns: random numbers in [0, 1] that belong to points or to cells of a lattice.

Jenkins 2006, "lookup3"; Jarzynski and Olano 2020, "Hash Functions for GPU Rendering" (pcg3d, pcg4d), on signed integers.
"""

import numpy as np

_U = np.uint32
_FINAL = (("c", "b", 14), ("a", "c", 11), ("b", "a", 25), ("c", "b", 16), ("a", "c", 4), ("b", "a", 14), ("c", "b", 24))
_MIX = (("a", "c", "b", 4), ("b", "a", "c", 6), ("c", "b", "a", 8), ("a", "c", "b", 16), ("b", "a", "c", 19), ("c", "b", "a", 4))
_MULTIPLIER, _INCREMENT = _U(1664525), _U(1013904223)
_PCG_STEPS = {2: ((0, 1, None), (1, 0, None)), 3: ((0, 1, 2), (1, 2, 0), (2, 0, 1)), 4: ((0, 1, 3), (1, 2, 0), (2, 0, 1), (3, 1, 2))}
_LARGEST = np.float32(2.0**31)


def jenkins(*words):
    """A hash uint32 (N,) of one to four words uint32 (N,): Jenkins' lookup3."""
    start = _U((0xDEADBEEF + (len(words) << 2) + 13) & 0xFFFFFFFF)
    shape = np.broadcast_shapes(*map(np.shape, words))
    a, b, c = (np.full(shape, start) for _ in range(3))
    for state, word in zip((a, b, c), words):
        state += word
    state = {"a": a, "b": b, "c": c}
    if len(words) == 4:
        for x, y, z, bits in _MIX:
            state[x] -= state[y]
            state[x] ^= _rotated(state[y], bits)
            state[y] += state[z]
        a += words[3]
    for x, y, bits in _FINAL:
        state[x] ^= state[y]
        state[x] -= _rotated(state[y], bits)
    return c


def _rotated(x, bits):
    result = x << _U(bits)
    result |= x >> _U(32 - bits)
    return result


def unit(*numbers):
    """A number in [0, 1], float32 (N,), for each one to four numbers float32: equal bits get equal numbers."""
    words = [np.ascontiguousarray(x, np.float32).view(_U) for x in numbers]
    return jenkins(*words).astype(np.float32) * np.float32(2.0**-32)


def unit3(*numbers):
    """Three numbers in [0, 1], float32 (3, N), for each one to four numbers: the colours of cells and of white noise."""
    if len(numbers) < 4:
        return np.stack((unit(*numbers), unit(*numbers, 1), unit(*numbers, 2)))
    x, y, z, w = numbers
    return np.stack((unit(x, y, z, w), unit(z, x, w, y), unit(w, z, y, x)))


def pcg(cell):
    """As many numbers in [0, 1] as there are coordinates, float32 (D, N), D = 2 to 4, for cells int32 (D, N)."""
    v = cell.view(_U) * _MULTIPLIER + _INCREMENT
    for _ in range(2):
        for row, x, y in _PCG_STEPS[len(v)]:
            v[row] += v[x] * (_MULTIPLIER if y is None else v[y])
        if _ == 0:
            # Signed numbers are shifted with their sign.
            v ^= (v.view(np.int32) >> np.int32(16)).view(_U)
    v &= _U(0x7FFFFFFF)
    return v.view(np.int32).astype(np.float32) * np.float32(2.0**-31)


def whole(x):
    """Whole numbers float32 as int32, beyond its range the least, as processors convert."""
    return np.where(np.abs(x) < _LARGEST, x, -_LARGEST).astype(np.int32)
