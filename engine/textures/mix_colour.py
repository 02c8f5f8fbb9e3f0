"""Two colours blended."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.blending import BLENDS
from ..maths.vectors import as_vector
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class MixColour:
    """Blender's Mix of colours: `blend`, see `maths.blending.BLENDS`, b over a by `factor`.

    clamps_factor, clamps_result  whether these are cut off to [0, 1]
    """

    key = "mix colour"
    label = "Mix Color"

    factor: object = 0.5
    a: object = (0.5, 0.5, 0.5)
    b: object = (0.5, 0.5, 0.5)
    blend: str = "mix"
    clamps_factor: bool = True
    clamps_result: bool = False

    def check(self, owner):
        if self.blend not in BLENDS:
            raise SceneError(f"{owner}: blend of Mix is '{self.blend}', allowed: {', '.join(BLENDS)}")

    def eval(self, at):
        t = at.value(self.factor)
        t = np.clip(t, 0, 1) if self.clamps_factor else t
        with np.errstate(all="ignore"):
            colour = BLENDS[self.blend](as_vector(at.value(self.a)), as_vector(at.value(self.b)), t)
        return np.clip(colour, 0, 1) if self.clamps_result else colour
