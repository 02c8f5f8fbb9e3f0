"""Numbers carried from one range to another: how far a is on its way from `low` to `high`, as Blender's Map Range has it."""

import numpy as np

from .arithmetic import divided


def clamped(a, low, high):
    """a cut off to [low, high], or to [high, low] if that is empty."""
    return np.clip(a, np.minimum(low, high), np.maximum(low, high))


def linear(a, low, high, steps):
    """How far, and 0 for a range without extent."""
    return divided(a - low, high - low)


def stepped(a, low, high, steps):
    """The same in `steps` steps, and 0 where there are none."""
    return np.where(steps > 0, divided(np.floor(linear(a, low, high, steps) * (steps + 1)), steps), np.float32(0))


def smooth(a, low, high, steps):
    """The same, cut off to [0, 1] and eased: 3 t^2 - 2 t^3."""
    t = np.clip(linear(a, low, high, steps), 0, 1)
    return (3 - 2 * t) * (t * t)


def smoother(a, low, high, steps):
    """6 t^5 - 15 t^4 + 10 t^3 (Perlin 2002)."""
    t = np.clip(linear(a, low, high, steps), 0, 1)
    return t * t * t * (t * (t * 6 - 15) + 10)


PROGRESS = {"linear": linear, "stepped": stepped, "smoothstep": smooth, "smootherstep": smoother}
