"""Colours turned around the wheel."""

from dataclasses import dataclass

import numpy as np

from ..maths.arithmetic import fraction
from ..maths.colour_models import hsv_from_rgb, rgb_from_hsv
from ..maths.vectors import as_vector
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class HueSaturation:
    """Blender's Hue/Saturation/Value, by `factor`: a hue of 0.5 leaves the colour's own, as a saturation and value of 1 do."""

    key = "hue saturation"
    label = "Hue/Saturation/Value"

    colour: object = (0.8, 0.8, 0.8)
    hue: object = 0.5
    saturation: object = 1.0
    value: object = 1.0
    factor: object = 1.0

    def check(self, owner):
        pass

    def eval(self, at):
        colour, factor = as_vector(at.value(self.colour)), at.value(self.factor)
        h, s, v = hsv_from_rgb(colour)
        turned = fraction(h + at.value(self.hue)[0] + np.float32(0.5))
        other = np.stack(np.broadcast_arrays(turned, np.clip(s * at.value(self.saturation)[0], 0, 1), v * at.value(self.value)[0]))
        return np.maximum(factor * rgb_from_hsv(other) + (1 - factor) * colour, 0)
