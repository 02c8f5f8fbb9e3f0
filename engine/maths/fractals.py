"""Sums and products over octaves of noise (Musgrave in Ebert et al. 2003, "Texturing and Modeling", chapter 16), as Blender's.

Parameters are float32, (1,) or (N,): detail >= 0, the number of octaves beyond the first, of which the last counts as much
as what is left of `detail` below a whole number; roughness, the strength of an octave compared to the one before; lacunarity,
likewise its fineness; offset, what is added to the noise; gain, how much octaves count where those before them are large.
"""

import numpy as np

from .perlin import MEAN_SIZES, noise

_LEAST_WEIGHT = np.float32(0.001)
"""Blender's: from there on a hybrid multifractal has no finer octaves."""
_TOGETHER = 2**12
"""Points of noise that are looked up at once where there are few: calls of NumPy cost as much as that."""


def fbm(octaves, roughness, offset, gain, is_normalized):
    """Fractional Brownian motion: the sum of octaves; normalised to [0, 1] about 1/2."""
    result = total = most = np.float32(0)
    amplitude = np.float32(1)
    for signal, share in octaves:
        total = total + amplitude * signal
        most = most + amplitude
        value = np.float32(0.5) * total / most + np.float32(0.5) if is_normalized else total
        result = (1 - share) * result + share * value
        amplitude = amplitude * roughness
    return result


def multifractal(octaves, roughness, offset, gain, is_normalized):
    """The product of octaves about 1."""
    value = power = np.float32(1)
    for signal, share in octaves:
        value = value * (share * power * signal + 1)
        power = power * roughness
    return value


def hetero_terrain(octaves, roughness, offset, gain, is_normalized):
    """Octaves that grow with the height that those before them reach."""
    value, power = None, np.float32(1)
    for signal, share in octaves:
        signal = signal + offset
        value = signal if value is None else value + share * signal * power * value
        power = power * roughness
    return value


def hybrid_multifractal(octaves, roughness, offset, gain, is_normalized):
    """Octaves weighted by the product of those before them: rough heights above smooth valleys."""
    value, power, weight = np.float32(0), np.float32(1), np.float32(1)
    for signal, share in octaves:
        is_on = weight > _LEAST_WEIGHT
        signal = (signal + offset) * power
        weight = np.minimum(weight, np.float32(1))
        value = value + np.where(is_on, share * weight * signal, 0)
        weight = np.where(is_on, weight * gain * signal, weight)
        power = power * roughness
    return value


def ridged_multifractal(octaves, roughness, offset, gain, is_normalized):
    """Octaves folded up at 0 into ridges, weighted by the octave before; of parts of octaves there is nothing."""
    value, power, weight = np.float32(0), np.float32(1), np.float32(1)
    for signal, share in octaves:
        signal = (offset - signal) ** 2 * weight
        value = value + np.where(share == 1, signal * power, 0)
        weight = np.clip(signal * gain, 0, 1)
        power = power * roughness
    return value


FRACTALS = {
    "fbm": fbm,
    "multifractal": multifractal,
    "hybrid multifractal": hybrid_multifractal,
    "ridged multifractal": ridged_multifractal,
    "hetero terrain": hetero_terrain,
}


def fractal(p, half, kind, detail, roughness, lacunarity, offset=1.0, gain=1.0, is_normalized=False):
    """A fractal of `kind`, see FRACTALS, of noise at p (D, N), (N,); `half` (N,) is half the extent of a footprint, or None for points.

    Octaves fade where the footprint grows from a half to one of their cells (clamping: Norton, Rockwood and Skolnick 1982).
    """
    detail, roughness, lacunarity, offset, gain = (np.float32(x) for x in (detail, roughness, lacunarity, offset, gain))
    octaves = _octaves(p, half, detail, lacunarity, is_folded=kind == "ridged multifractal")
    return FRACTALS[kind](octaves, roughness, offset, gain, is_normalized)


def _octaves(p, half, detail, lacunarity, is_folded):
    """Noise of each octave (N,), for ridges its size, and how much of it counts, from 0 to 1."""
    scales = [np.ones_like(lacunarity)]
    for _ in range(int(np.ceil(detail.max(initial=0)))):
        scales.append(scales[-1] * lacunarity)
    several = max(1, _TOGETHER // max(p.shape[1], 1))
    for first in range(0, len(scales), several):
        scale = np.stack(scales[first : first + several]).reshape(-1, lacunarity.size)
        for i, signal in enumerate(_faded(scale, p, half, is_folded), first):
            yield signal, np.clip(detail - np.float32(i - 1), 0, 1)


def _faded(scale, p, half, is_folded):
    """Noise of octaves (O, N) that are as fine as `scale` (O, 1 or N), or its size, as much of it as is seen."""
    q = scale * p[:, None]
    if half is None:
        signal = noise(q.reshape(len(p), -1)).reshape(q.shape[1:])
        return np.abs(signal) if is_folded else signal
    fade = np.clip(2 - np.abs(4 * scale) * half, 0, 1)
    fade = fade * fade * (3 - 2 * fade)
    signal = _where_seen(q, fade)
    if is_folded:
        return fade * np.abs(signal) + (1 - fade) * np.float32(MEAN_SIZES[len(p)])
    return fade * signal


def _where_seen(q, fade):
    """Noise (O, N) at q (D, O, N), 0 where there is nothing of it to be seen."""
    shape = np.broadcast_shapes(q.shape[1:], fade.shape)
    q = np.broadcast_to(q, (len(q), *shape)).reshape(len(q), -1)
    if fade.all():
        return noise(q).reshape(shape)
    signal, seen = np.zeros(q.shape[1], np.float32), np.nonzero(np.broadcast_to(fade, shape).ravel())[0]
    signal[seen] = noise(q.take(seen, axis=1))
    return signal.reshape(shape)
