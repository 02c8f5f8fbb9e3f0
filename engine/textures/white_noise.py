"""White noise."""

from dataclasses import dataclass

from ..errors import SceneError
from ..maths.cellhash import unit, unit3
from ..scene.coordinates import GENERATED
from ..scene.placing import placed
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class WhiteNoiseTexture:
    """Blender's random number in [0, 1] for each point; points that differ in the last bit have nothing in common.

    w           the fourth coordinate, or the only one
    dimensions  1 to 4
    output      "value", or "color": three numbers
    """

    key = "white noise"
    label = "White Noise"
    is_pure = False

    coordinates: object = GENERATED
    w: object = 0.0
    dimensions: int = 3
    output: str = "value"

    def check(self, owner):
        if self.dimensions not in (1, 2, 3, 4):
            raise SceneError(f"{owner}: white noise has {self.dimensions} dimensions, allowed: 1 to 4")
        if self.output not in ("value", "color"):
            raise SceneError(f"{owner}: white noise gives '{self.output}', allowed: value, color")

    def eval(self, at):
        p, _ = placed(at, self.coordinates, w=self.w, dimensions=self.dimensions)
        return unit(*p)[None] if self.output == "value" else unit3(*p)
