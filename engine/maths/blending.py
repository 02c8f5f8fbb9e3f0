"""Two colours blended, a below and b above, by the factor t: BLENDS names Blender's ways.

Colours are rows (3, N) float32, of any size and sign; t is (1, N).
"""

import numpy as np

from .arithmetic import divided
from .colour_models import hsv_from_rgb, rgb_from_hsv


def blend(a, b, t):
    """From a to b."""
    return a + t * (b - a)


def screen(a, b, t):
    """1 - (1 - a)(1 - b)."""
    return 1 - (1 - t + t * (1 - b)) * (1 - a)


def overlay(a, b, t):
    """Multiplied where a is dark, screened where it is bright."""
    return np.where(a < 0.5, a * (1 - t + 2 * t * b), 1 - (1 - t + 2 * t * (1 - b)) * (1 - a))


def divide(a, b, t):
    """a / b, and a where b is 0."""
    return np.where(b != 0, (1 - t) * a + t * divided(a, b), a)


def dodge(a, b, t):
    """a / (1 - b), at most 1."""
    rest = 1 - t * b
    return np.where(a == 0, np.float32(0), np.where(rest <= 0, np.float32(1), np.minimum(divided(a, rest), 1)))


def burn(a, b, t):
    """1 - (1 - a) / b, cut off to [0, 1]."""
    part = 1 - t + t * b
    return np.where(part <= 0, np.float32(0), np.clip(1 - divided(1 - a, part), 0, 1))


def soft_light(a, b, t):
    """A screen that a fades in."""
    return (1 - t) * a + t * ((1 - a) * b * a + a * (1 - (1 - b) * (1 - a)))


def hue(a, b, t):
    """a with the hue of b, where that has one."""
    (h, s, _), (_, saturation, value) = hsv_from_rgb(b), hsv_from_rgb(a)
    return np.where(s != 0, blend(a, rgb_from_hsv(np.stack(np.broadcast_arrays(h, saturation, value))), t), a)


def saturation(a, b, t):
    """a with the saturation of b, where a has a hue."""
    h, s, v = hsv_from_rgb(a)
    mixed = (1 - t[0]) * s + t[0] * hsv_from_rgb(b)[1]
    return np.where(s != 0, rgb_from_hsv(np.stack(np.broadcast_arrays(h, mixed, v))), a)


def value(a, b, t):
    """a with the value of b."""
    h, s, v = hsv_from_rgb(a)
    return rgb_from_hsv(np.stack(np.broadcast_arrays(h, s, (1 - t[0]) * v + t[0] * hsv_from_rgb(b)[2])))


def colour(a, b, t):
    """a with the hue and saturation of b, where that has one."""
    h, s, _ = hsv_from_rgb(b)
    return np.where(s != 0, blend(a, rgb_from_hsv(np.stack(np.broadcast_arrays(h, s, hsv_from_rgb(a)[2]))), t), a)


BLENDS = {
    "mix": blend,
    "darken": lambda a, b, t: blend(a, np.minimum(a, b), t),
    "multiply": lambda a, b, t: blend(a, a * b, t),
    "burn": burn,
    "lighten": lambda a, b, t: blend(a, np.maximum(a, b), t),
    "screen": screen,
    "dodge": dodge,
    "add": lambda a, b, t: blend(a, a + b, t),
    "overlay": overlay,
    "soft light": soft_light,
    "linear light": lambda a, b, t: a + t * (2 * b - 1),
    "difference": lambda a, b, t: blend(a, np.abs(a - b), t),
    "exclusion": lambda a, b, t: np.maximum(blend(a, a + b - 2 * a * b, t), 0),
    "subtract": lambda a, b, t: blend(a, a - b, t),
    "divide": divide,
    "hue": hue,
    "saturation": saturation,
    "color": colour,
    "value": value,
}
