"""Which way a surface faces, and where in a triangle a point is."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.facing import mirrored, turned, unit
from . import registry

_TO_OBJECT, _IN_TRIANGLE = ("world_from_object", ""), ("parametric", "")
_ASKED = {"object normal": (_TO_OBJECT,), "parametric": (_IN_TRIANGLE,)}
_OUTPUTS = {
    "normal": lambda at: at.surface.ns,
    "object normal": lambda at: unit(turned(at.attribute(_TO_OBJECT)[0], at.surface.ns)),
    "true normal": lambda at: at.surface.n,
    "incoming": lambda at: -at.d,
    "reflection": lambda at: mirrored(at.d, at.surface.ns),
    "parametric": lambda at: at.attribute(_IN_TRIANGLE)[0],
    "backfacing": lambda at: 1 - at.surface.is_front[None].astype(np.float32),
}


@registry.add
@dataclass(frozen=True, eq=False)
class Geometry:
    """What is known of a point by the surface that is met there, in world space.

    output  "normal" for shading, and "object normal", the same in object space; "true normal" of the triangle; all on the viewer's
            side; "incoming", towards the viewer; "reflection", where a mirror would look; "parametric", the shares of the first and
            the second corner of its triangle; "backfacing", 1 or 0
    """

    key = "geometry"
    label = "Geometry"
    is_pure = False

    output: str = "normal"

    @property
    def asks_for_cosine(self):
        """See `interfaces.asks_for_cosine`."""
        return self.output == "backfacing"

    def check(self, owner):
        if self.output not in _OUTPUTS:
            raise SceneError(f"{owner}: output of its geometry is '{self.output}', allowed: {', '.join(_OUTPUTS)}")

    @property
    def attributes(self):
        """What meshes and objects must bring, see `world.attributes`."""
        return _ASKED.get(self.output, ())

    def eval(self, at):
        return _OUTPUTS[self.output](at)
