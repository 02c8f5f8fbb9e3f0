"""Points as the camera sees them."""

from dataclasses import dataclass

from ..errors import SceneError
from ..maths.facing import unit
from ..maths.vectors import length
from . import registry


def _point(at):
    return at.attribute(("camera", ""))[0]


_OUTPUTS = {
    "window": lambda at: at.in_window,
    "vector": lambda at: unit(_point(at)),
    "depth": lambda at: _point(at)[2:],
    "distance": lambda at: length(_point(at))[None],
}


@registry.add
@dataclass(frozen=True, eq=False)
class CameraData:
    """A point in the frame of the camera, which looks along +z, x to the right, y up; as it is at the middle of the shutter.

    output  "window", (x, y, 0) in the picture from (0, 0) at its lower left to (1, 1); "vector", unit, towards the
            point; "depth" along the axis and "distance" in a straight line [m]
    """

    key = "camera data"
    label = "Camera Data"
    is_pure = False

    output: str = "vector"

    def check(self, owner):
        if self.output not in _OUTPUTS:
            raise SceneError(f"{owner}: output of its camera data is '{self.output}', allowed: {', '.join(_OUTPUTS)}")

    def eval(self, at):
        return _OUTPUTS[self.output](at)
