"""Cubes of two colours in turn."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..scene.coordinates import GENERATED
from . import registry

_SHIFT, _SHRINK = 1e-6, 0.999999
"""Blender's: faces of cubes are moved off the whole numbers, where surfaces like to lie."""


@registry.add
@dataclass(frozen=True, eq=False)
class CheckerTexture:
    """Cubes, `odd` where an odd number of the three whole coordinates is odd, else `even`: Blender's, `scale` to each unit.

    output  "color", or "fac": 1 where odd

    Averaged over a box around the footprint of a ray, in closed form: it turns grey with distance, not into patterns.
    """

    key = "checker"
    label = "Checker"
    has_detail = True

    odd: object = (0.8, 0.8, 0.8)
    even: object = (0.2, 0.2, 0.2)
    coordinates: object = GENERATED
    scale: object = 1.0
    output: str = "color"

    def check(self, owner):
        if self.output not in ("color", "fac"):
            raise SceneError(f"{owner}: checker gives '{self.output}', allowed: color, fac")

    def eval(self, at):
        p, axes = at.look_up(self.coordinates)
        scale = at.value(self.scale)
        p = (p * scale + np.float32(_SHIFT)) * np.float32(_SHRINK)
        # The box that holds the ellipse of half-axes a, b is sqrt(a^2 + b^2) wide to both sides.
        signs = 1 - 2 * (np.floor(p) % 2) if axes is None else mean_sign(p, np.abs(scale) * np.sqrt(axes[0] ** 2 + axes[1] ** 2))
        share = 0.5 - 0.5 * (signs[0] * signs[1] * signs[2])
        if self.output == "fac":
            return share[None]
        odd, even = at.value(self.odd), at.value(self.even)
        # So that it is exactly one of both where there is nothing to average.
        return share * odd + (1 - share) * even


def mean_sign(x, half):
    """The mean over [x - half, x + half] of +1 on even and -1 on odd unit intervals; float32 of any shape.

    Its integral is the triangle wave (Quilez 2016, "Filterable procedural textures"). Intervals shorter than 1 hold but
    one edge, from whose distance the mean follows without cancellation, exactly +1 or -1 where no edge is met.
    """
    edge = np.floor(x + np.float32(0.5))
    # The distance to the nearest whole number, positive on the side where the sign is +1.
    distance = (x - edge) * (1 - 2 * (edge % 2))
    near = np.clip(distance / np.maximum(half, np.finfo(np.float32).tiny), -1, 1)
    far = (_triangle_wave(x + half) - _triangle_wave(x - half)) / (2 * np.maximum(half, np.float32(0.25)))
    return np.where(half <= np.float32(0.5), near, far)


def _triangle_wave(x):
    """Integral of the sign from 0 to x: up to 1 at odd numbers, down to 0 at even ones."""
    return 1 - np.abs(x - 2 * np.floor(0.5 * x) - 1)
