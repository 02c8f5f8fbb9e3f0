"""The clear sky by a formula."""

import math
from dataclasses import dataclass

import numpy as np

from ..constants import PI
from ..errors import SceneError
from ..maths.spectrum import FROM_XYZ
from ..maths.vectors import dot, length
from ..scene.coordinates import GENERATED
from . import registry

_SLOPES = np.array(
    (
        ((17870, -146300), (-35540, 42750), (-2270, 532510), (12060, -257710), (-6700, 37030)),
        ((-1930, -25920), (-6650, 80), (-40, 21250), (-6410, -89890), (-330, 4520)),
        ((-1670, -26080), (-9500, 920), (-790, 21020), (-4410, -165370), (-1090, 5290)),
    )
) / 1e5
"""The parameters of Perez' formula for Y, x and y: linear in the turbidity (table 2)."""
_ZENITH = np.array(
    (
        ((166, -375, 209, 0), (-2903, 6377, -3202, 394), (11693, -21196, 6052, 25886)),
        ((275, -610, 317, 0), (-4214, 8970, -4153, 516), (15346, -26756, 6670, 26688)),
    )
) / 1e5
"""x and y at the zenith: quadratic in the turbidity, cubic in the sun's angle (appendix A.2)."""
_UNIT = 0.06
"""The scale that Blender gives to what the paper has in kcd m^-2."""
_LOWEST = np.float32(0.5 * PI - 1 / 1000)


@registry.add
@dataclass(frozen=True, eq=False)
class PreethamSky:
    """Radiance of a clear sky in the direction of `coordinates` (Preetham, Shirley and Smits 1999, "A Practical Analytic
    Model for Daylight", appendix A.2), in Blender's scale.

    sun        direction of the sun, unit
    turbidity  haze: 2 is clear, 10 hazy
    Below the horizon it is as at the horizon.
    """

    key = "preetham sky"
    label = "Preetham Sky"

    coordinates: object = GENERATED
    sun: tuple = (0.0, 0.0, 1.0)
    turbidity: float = 2.2

    def check(self, owner):
        if not (len(self.sun) == 3 and all(map(math.isfinite, self.sun)) and any(self.sun)):
            raise SceneError(f"'{owner}': the sun of its sky stands at {self.sun}, allowed: a direction")
        if not 1 <= self.turbidity <= 30:
            raise SceneError(f"'{owner}': turbidity of its sky is {self.turbidity}, allowed: 1 to 30")

    def eval(self, at):
        d, _ = at.look_up(self.coordinates)
        d = d / np.maximum(length(d), np.finfo(np.float32).tiny)
        sun = np.array(self.sun, np.float64)
        sun /= np.linalg.norm(sun)
        chi, T = math.acos(min(max(sun[2], -1.0), 1.0)), self.turbidity
        middle = (4.0453 * T - 4.9710) * math.tan((4 / 9 - T / 120) * (PI - 2 * chi)) - 0.2155 * T + 2.4192
        zenith = (_UNIT * middle, *(np.array((T * T, T, 1)) @ _ZENITH @ np.array((chi**3, chi**2, chi, 1))))
        theta = np.minimum(np.arccos(np.clip(d[2], -1, 1)), _LOWEST)
        gamma = np.arccos(np.clip(dot(d, sun.astype(np.float32)[:, None]), -1, 1))
        Y, x, y = (
            value * (_perez(c, theta, gamma) / _perez(c, np.float32(0), np.float32(chi))).astype(np.float32)
            for value, c in zip(zenith, (_SLOPES @ np.array((T, 1.0))).tolist())
        )
        y = np.maximum(y, np.finfo(np.float32).tiny)
        X, Z = x / y * Y, (1 - x - y) / y * Y
        return np.stack([np.maximum(r[0] * X + r[1] * Y + r[2] * Z, 0) for r in FROM_XYZ.astype(np.float32)]).astype(np.float32)


def _perez(c, theta, gamma):
    """Perez' distribution of luminance (eq. 3)."""
    cos = np.cos(gamma)
    return (1 + c[0] * np.exp(c[1] / np.cos(theta))) * (1 + c[2] * np.exp(c[3] * gamma) + c[4] * cos * cos)
