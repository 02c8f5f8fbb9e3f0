"""Colours as hue, saturation and value or lightness (Smith 1978, "Color Gamut Transform Pairs"; Joblove and Greenberg 1978).

Colours are rows (3, N) float32 in and out; hues are in turns. The functions take colours beyond [0, 1] too, as Cycles' do.
"""

import numpy as np

from .arithmetic import divided


def hsv_from_rgb(colour):
    """Hue, saturation (max - min) / max and value max."""
    top = colour.max(axis=0)
    span = top - colour.min(axis=0)
    saturation = divided(span, top)
    red, green, blue = divided(top - colour, span)
    hue = np.where(colour[0] == top, blue - green, np.where(colour[1] == top, 2 + red - blue, 4 + green - red)) / np.float32(6)
    hue = np.where(hue < 0, hue + 1, hue)
    return np.stack((np.where(saturation != 0, hue, np.float32(0)), saturation, top))


def rgb_from_hsv(colour):
    """The inverse of `hsv_from_rgb`; hues below 0 or beyond 1 count as the last sixth."""
    hue, saturation, value = colour
    hue = np.where(hue == 1, np.float32(0), hue) * 6
    sixth = np.floor(hue)
    f = hue - sixth
    p = value * (1 - saturation)
    q = value * (1 - saturation * f)
    t = value * (1 - saturation * (1 - f))
    which = np.where((sixth >= 0) & (sixth < 5), sixth, 5).astype(np.intp)
    channels = (value, q, p, p, t, value), (t, value, value, q, p, p), (p, p, t, value, value, q)
    found = np.stack([np.choose(which, parts) for parts in channels])
    return np.where(saturation != 0, found, value)


def hsl_from_rgb(colour):
    """Hue, saturation and lightness, (max + min) / 2 but at most 1."""
    top, bottom = colour.max(axis=0), colour.min(axis=0)
    span, total = top - bottom, top + bottom
    lightness = np.minimum(total * np.float32(0.5), 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        saturation = span / np.where(lightness > 0.5, 2 - top - bottom, total)
    red, green, blue = colour
    hue = np.where(
        red == top,
        divided(green - blue, span) + np.where(green < blue, np.float32(6), np.float32(0)),
        np.where(green == top, divided(blue - red, span) + 2, divided(red - green, span) + 4),
    )
    is_grey = span == 0
    return np.stack((np.where(is_grey, np.float32(0), hue / np.float32(6)), np.where(is_grey, np.float32(0), saturation), lightness))


def rgb_from_hsl(colour):
    """The inverse of `hsl_from_rgb`."""
    hue, saturation, lightness = colour
    full = np.clip(np.stack((np.abs(hue * 6 - 3) - 1, 2 - np.abs(hue * 6 - 2), 2 - np.abs(hue * 6 - 4))), 0, 1)
    chroma = (1 - np.abs(2 * lightness - 1)) * saturation
    return (full - np.float32(0.5)) * chroma + lightness


def _same(colour):
    return colour


FROM_RGB = {"rgb": _same, "hsv": hsv_from_rgb, "hsl": hsl_from_rgb}
TO_RGB = {"rgb": _same, "hsv": rgb_from_hsv, "hsl": rgb_from_hsl}
"""By the names of the models."""
