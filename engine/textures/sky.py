"""The clear sky."""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.atmosphere import LIMB, MEAN_OF_DISC, sky_table, sun_radiance
from ..maths.vectors import length
from ..scene.coordinates import GENERATED
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class SkyTexture:
    """Radiance of a clear sky in the direction of `coordinates`, see `maths.atmosphere`.

    sun_elevation           above the horizon [rad]
    sun_rotation            from +y towards +x [rad]
    altitude                of the eye [m]
    air, aerosols, ozone    how dense they are, compared to a clear day
    sun_angle               diameter of the sun's disc [rad]; 0: no disc
    sun_intensity           factor of its radiance
    Below the horizon it fades to black.
    """

    key = "sky"
    label = "Sky"

    coordinates: object = GENERATED
    sun_elevation: float = 0.2617994
    sun_rotation: float = 0.0
    altitude: float = 100.0
    air: float = 1.0
    aerosols: float = 1.0
    ozone: float = 1.0
    sun_angle: float = 0.0
    sun_intensity: float = 1.0

    @property
    def sun(self):
        """Unit vector to the middle of the sun."""
        cos = math.cos(self.sun_elevation)
        return cos * math.sin(self.sun_rotation), cos * math.cos(self.sun_rotation), math.sin(self.sun_elevation)

    @property
    def sun_radiance(self):
        """Radiance (3,) of the middle of the sun's disc."""
        return self.sun_intensity * sun_radiance(self.sun_elevation, self.sun_angle, self.altitude, self.air, self.aerosols)

    @property
    def sun_irradiance(self):
        """What arrives of the disc on a surface that faces it (3,) [W m^-2]."""
        return self.sun_radiance * (MEAN_OF_DISC * math.pi * math.sin(0.5 * self.sun_angle) ** 2)

    def check(self, owner):
        for name, most in (("altitude", 1e7), ("air", 1e3), ("aerosols", 1e3), ("ozone", 1e3)):
            if not 0 <= getattr(self, name) <= most:
                raise SceneError(f"'{owner}': {name} of its sky is {getattr(self, name)}, allowed: 0 to {most:g}")
        if not (0 <= self.sun_angle < math.pi and 0 <= self.sun_intensity < math.inf):
            raise SceneError(f"'{owner}': the sun of its sky is {self.sun_angle} wide and {self.sun_intensity} bright")
        if not (math.isfinite(self.sun_elevation) and math.isfinite(self.sun_rotation)):
            raise SceneError(f"'{owner}': the sun of its sky is nowhere")

    def eval(self, at):
        d, _ = at.look_up(self.coordinates)
        x, y, z = (d / np.maximum(length(d), np.finfo(np.float32).tiny)).astype(np.float32)
        table = sky_table(self.sun_elevation, self.altitude, self.air, self.aerosols, self.ozone)
        _, rows, columns = table.shape
        row = np.sqrt(np.arcsin(np.clip(z, 0, 1)) * np.float32(2 / np.pi)) * np.float32(rows - 1)
        turn = np.arctan2(x, y) - np.float32(self.sun_rotation)
        # To the same side of the sun, whichever it is.
        turn = np.abs(turn - np.float32(2 * np.pi) * np.round(turn * np.float32(0.5 / np.pi)))
        column = turn * np.float32((columns - 1) / np.pi)
        value = _bilinear(table, row, column)
        fade = np.maximum(1 + np.float32(2.5) * np.minimum(z, 0), 0)
        value *= fade * fade * fade
        return self._with_disc(value, x, y, z) if self.sun_angle else value

    def _with_disc(self, value, x, y, z):
        sun = np.array(self.sun, np.float32)
        # Of the chord: near the middle the cosine has no digits left.
        chord = length((x - sun[0], y - sun[1], z - sun[2])) / np.float32(2 * math.sin(0.25 * self.sun_angle))
        seen = np.nonzero((chord < 1) & (z >= 0))[0]
        limb = 1 - np.float32(LIMB) * (1 - np.sqrt(1 - chord.take(seen) ** 2))
        value[:, seen] = self.sun_radiance.astype(np.float32)[:, None] * limb
        return value


def _bilinear(table, row, column):
    _, rows, columns = table.shape
    i, j = np.minimum(row.astype(np.intp), rows - 2), np.minimum(column.astype(np.intp), columns - 2)
    a, b = (row - i).astype(np.float32), (column - j).astype(np.float32)
    flat, first = table.reshape(3, -1), i * columns + j
    upper = (1 - b) * flat.take(first, axis=1) + b * flat.take(first + 1, axis=1)
    lower = (1 - b) * flat.take(first + columns, axis=1) + b * flat.take(first + columns + 1, axis=1)
    return (1 - a) * upper + a * lower
