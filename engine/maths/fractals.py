"""Sums and products over octaves of noise (Musgrave in Ebert et al. 2003, "Texturing and Modeling", chapter 16), as Blender's.

Parameters are float32, (1,) or (N,): detail >= 0, the number of octaves beyond the first, of which the last counts as much
as what is left of `detail` below a whole number; roughness, the strength of an octave compared to the one before; lacunarity,
likewise its fineness; offset, what is added to the noise; gain, how much octaves count where those before them are large.
"""

import numpy as np

from .perlin import MEAN_SIZES, noise

_LEAST_WEIGHT = np.float32(0.001)
"""Blender's: from there on a hybrid multifractal has no finer octaves."""


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
    scale = np.float32(1)
    for i in range(int(np.ceil(detail.max(initial=0))) + 1):
        signal = noise(scale * p)
        mean = np.float32(0)
        if is_folded:
            signal, mean = np.abs(signal), np.float32(MEAN_SIZES[len(p)])
        if half is not None:
            fade = np.clip(2 - np.abs(4 * scale) * half, 0, 1)
            fade = fade * fade * (3 - 2 * fade)
            signal = fade * signal + (1 - fade) * mean
        yield signal, np.clip(detail - np.float32(i - 1), 0, 1)
        scale = scale * lacunarity
