"""Three numbers as one value."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.colour_models import TO_RGB
from ..scene.placing import numbers
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Combine:
    """The vector (x, y, z), or the colour that they are in the colour `model`: rgb, hsv or hsl."""

    key = "combine"
    label = "Combine"

    x: object = 0.0
    y: object = 0.0
    z: object = 0.0
    model: str = "rgb"

    def check(self, owner):
        if self.model not in TO_RGB:
            raise SceneError(f"{owner}: model of Combine is '{self.model}', allowed: {', '.join(TO_RGB)}")

    def eval(self, at):
        return TO_RGB[self.model](np.stack(np.broadcast_arrays(*numbers(at, self.x, self.y, self.z))))
