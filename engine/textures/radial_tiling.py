"""Segments around a point."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.tiling import segment_number, tiles
from ..maths.vectors import as_vector
from ..scene.placing import numbers
from . import registry

_OUTPUTS = ("coordinates", "number", "width", "rotation")


@registry.add
@dataclass(frozen=True, eq=False)
class RadialTiling:
    """Blender's Radial Tiling: the plane of `vector`'s x and y in segments, see `maths.tiling`.

    sides          how many; a broken number has one smaller segment; from 2 on, a strip
    roundness      of their corners, 0 to 1
    output         "coordinates": (u, v, 0); "number" of the segment, its "width" and "rotation"
    is_normalized  u goes from 0 to 1, v from 0 on
    """

    key = "radial tiling"
    label = "Radial Tiling"

    vector: object = (0.0, 0.0, 0.0)
    sides: object = 5.0
    roundness: object = 0.0
    output: str = "coordinates"
    is_normalized: bool = False

    def check(self, owner):
        if self.output not in _OUTPUTS:
            raise SceneError(f"{owner}: output of Radial Tiling is '{self.output}', allowed: {', '.join(_OUTPUTS)}")

    def eval(self, at):
        x, y, _ = as_vector(at.value(self.vector))
        sides, roundness = numbers(at, self.sides, self.roundness)
        sides = np.fmax(sides, np.float32(2))
        if self.output == "number":
            return segment_number(x, y, sides)[None]
        with np.errstate(all="ignore"):
            found = tiles(x, y, sides, np.clip(roundness, 0, 1), self.is_normalized)
        if self.output == "coordinates":
            return np.stack(np.broadcast_arrays(found.u, found.v, np.float32(0)))
        return getattr(found, self.output)[None]
