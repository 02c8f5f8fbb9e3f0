"""Which random number is used for what: dimensions have names, so that one feature does not reshuffle the others."""

from enum import IntEnum


class Dimension(IntEnum):
    """Numbers for one path, and for each of its bounces (from LIGHT on)."""

    FILTER = 0
    LENS = 1
    TIME = 2
    WAVELENGTH = 3
    LIGHT = 8
    LOBE = 9
    DIRECTION = 10
    ROULETTE = 11
    PASS = 12
    OCCLUSION = 13


_PER_BOUNCE = 8


def place(dimension, depth=0):
    """A dimension at a depth as one number, which samplers know it by."""
    return dimension + _PER_BOUNCE * depth
