"""The box filter: every point of the pixel counts the same."""

from . import registry


@registry.add
class Box:
    """Average over exactly one pixel: sharp, aliases most; neighbours share no noise."""

    key = "box"
    label = "Box"
    spans_pixels = False

    @staticmethod
    def offset(u2, width):
        return u2 - 0.5
