"""Light that falls off otherwise than with the square of the distance."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from . import registry

_POWERS = {"quadratic": 0, "linear": 1, "constant": 2}


@registry.add
@dataclass(frozen=True, eq=False)
class LightFalloff:
    """`strength` times the ray's length [m] to the power that leaves the light of a bulb the falloff; as Blender's node.

    falloff  "quadratic", as it is; "linear"; "constant"
    smooth   s [m^2]: close to the light it is weakened by t^2 / (s + t^2)
    What is infinitely far away, such as a sun, has no falloff.
    """

    key = "light falloff"
    label = "Light Falloff"
    is_pure = False

    strength: object = 1.0
    smooth: object = 0.0
    falloff: str = "quadratic"

    def check(self, owner):
        if self.falloff not in _POWERS:
            raise SceneError(f"{owner}: the falloff of a light is '{self.falloff}', allowed: {', '.join(_POWERS)}")

    def eval(self, at):
        strength, smooth, t = at.value(self.strength), at.value(self.smooth), at.path("length")
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            t2 = t * t
            gain = np.where(smooth > 0, t2 / (smooth + t2), np.float32(1))
            gain = gain * (np.ones_like(t), t, t2)[_POWERS[self.falloff]]
        return strength * np.where(t < np.finfo(np.float32).max, gain, np.float32(1))
