"""Brightness and contrast."""

from dataclasses import dataclass

import numpy as np

from ..maths.vectors import as_vector
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class BrightnessContrast:
    """Blender's: (1 + contrast) colour + brightness - contrast / 2, and nothing below 0."""

    key = "brightness contrast"
    label = "Brightness/Contrast"

    colour: object = (1.0, 1.0, 1.0)
    brightness: object = 0.0
    contrast: object = 0.0

    def check(self, owner):
        pass

    def eval(self, at):
        colour, contrast = as_vector(at.value(self.colour)), at.value(self.contrast)
        shift = at.value(self.brightness) - contrast * np.float32(0.5)
        return np.maximum((1 + contrast) * colour + shift, 0)
