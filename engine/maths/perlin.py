"""Gradient noise (Perlin 2002, "Improving Noise") over Jenkins' hash, with the very numbers of Blender's Noise Texture."""

import struct
from functools import lru_cache

import numpy as np

_U = np.uint32
_SCALE = np.float32(0.982)
"""Brings the noise of three dimensions into [-1, 1]."""
_PERIOD = np.float32(1e5)


def jenkins(*words):
    """A hash uint32 (N,) of two or three words uint32 (N,): the end of Jenkins' lookup3 (2006), with which Blender hashes."""
    start = _U((0xDEADBEEF + (len(words) << 2) + 13) & 0xFFFFFFFF)
    a, b = words[0] + start, words[1] + start
    c = words[2] + start if len(words) > 2 else np.full_like(a, start)
    for x, y, bits in ((c, b, 14), (a, c, 11), (b, a, 25), (c, b, 16), (a, c, 4), (b, a, 14), (c, b, 24)):
        x ^= y
        x -= (y << _U(bits)) | (y >> _U(32 - bits))
    return c


@lru_cache(maxsize=8)
def offset(seed):
    """(3, 1) float32 in [100, 200): where Blender looks up the noise number `seed` of one point."""
    words = [struct.unpack("<I", struct.pack("<f", value))[0] for value in (float(seed), 0.0, 1.0, 2.0)]
    hashes = jenkins(np.full(3, words[0], _U), np.array(words[1:], _U))
    return (100 + 100 * (hashes / 0xFFFFFFFF)).astype(np.float32)[:, None]


def noise(p):
    """Noise in [-1, 1] at p (3, N) float32, (N,): 0 at whole numbers, smooth between them, repeated every 100,000."""
    p = np.fmod(p, _PERIOD)
    cell = np.floor(p)
    p = p - cell
    cell = cell.astype(np.int32).view(_U)
    # The eight corners of the cell along a leading axis: bits of its index are steps along x, y, z.
    x, y, z = (np.stack((c, c + _U(1))) for c in cell)
    values = _products(jenkins(*_at_corners(x, y, z)), *_at_corners(*np.stack((p, p - 1), axis=1))).reshape(2, 2, 2, -1)
    u, v, w = p * p * p * (p * (p * 6 - 15) + 10)
    values = values[:, :, 0] + u * (values[:, :, 1] - values[:, :, 0])
    values = values[:, 0] + v * (values[:, 1] - values[:, 0])
    return _SCALE * (values[0] + w * (values[1] - values[0]))


def _at_corners(x, y, z):
    """What belongs to the low and the high side of a cell along each axis (2, N), at its corners (8, N)."""
    shape = (2, 2, 2, x.shape[1])
    return [np.broadcast_to(a, shape).reshape(8, -1) for a in (x, y[:, None], z[:, None, None])]


def _products(hashes, x, y, z):
    """The scalar products (8, N) of the ways (x, y, z) from the corners with the gradients that the hashes stand for."""
    kind = hashes & _U(15)
    first = np.where(kind < 8, x, y)
    second = np.where(kind < 4, y, np.where((kind == 12) | (kind == 14), x, z))
    first *= 1 - 2 * (kind & _U(1)).astype(np.float32)
    second *= 1 - (kind & _U(2)).astype(np.float32)
    return first + second


def fractal(p, half, detail, roughness, lacunarity, is_normalized):
    """The sum over octaves of noise at p (3, N), (N,); `half` (N,) is half the extent of a footprint, or None for points.

    Octaves fade where the footprint grows from a half to one of their cells (clamping: Norton, Rockwood and Skolnick 1982).
    """
    total, amplitude, most, scale = np.zeros_like(p[0]), 1.0, 0.0, 1.0
    octaves = int(detail)
    rest = detail - octaves

    def octave():
        value = noise(np.float32(scale) * p)
        if half is not None:
            fade = np.clip(2 - np.float32(4 * scale) * half, 0, 1)
            value *= fade * fade * (3 - 2 * fade)
        return np.float32(amplitude) * value

    for _ in range(octaves + 1):
        total += octave()
        most += amplitude
        amplitude *= roughness
        scale *= lacunarity
    finer = total + octave() if rest else total
    if is_normalized:
        finer = np.float32(0.5 / (most + (amplitude if rest else 0))) * finer + np.float32(0.5)
        total = np.float32(0.5 / most) * total + np.float32(0.5)
    return total + np.float32(rest) * (finer - total) if rest else total
