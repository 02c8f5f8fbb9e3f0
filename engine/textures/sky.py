"""The sky by day."""

from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np

from ..constants import PI
from ..errors import SceneError
from ..maths import atmosphere, scattering
from ..maths.daylight import preetham
from ..maths.skydome import hosek_wilkie
from ..maths.vectors import length
from ..scene.coordinates import GENERATED
from . import registry

_COLUMNS = 256
"""Of half the sky, which is the other half's mirror image: from opposite the sun to the sun."""
_ROWS = 128
"""Of the sky above the horizon: the closer to it, the denser."""
_LIMB = 0.6
"""How much darker the sun is at its edge."""
_SUNLESS = ("preetham", "hosek wilkie")
MODELS = (*_SUNLESS, "nishita", "single scattering", "multiple scattering")
_HIGHEST = {"nishita": 59999.0, "single scattering": 59999.0, "multiple scattering": 99999.0}


@registry.add
@dataclass(frozen=True, eq=False)
class SkyTexture:
    """The radiance of Blender's sky in the direction `coordinates`, +z up; the scattering models include the sun.

    model          "preetham": see `maths.daylight`; "hosek wilkie": see `maths.skydome`; "single scattering": see `maths.scattering`,
                   which Blender called "nishita" up to version 4.5, where the sun hides the sky; "multiple scattering": see
                   `maths.atmosphere`
    has_disk       the sun is seen, and gives light
    sun_size       its angular diameter [rad], above 0 to pi / 2
    sun_intensity  factor of its radiance
    sun_elevation  above the horizon [rad], -pi / 2 to pi / 2
    sun_rotation   from +y towards +x [rad]
    altitude       of the viewer [m]; from 1 m to the end of the atmosphere, 60 km, with multiple scattering 100 km
    air, haze, ozone   densities, 1 as on a clear day
    sun_direction, turbidity   of "preetham" and "hosek wilkie" alone: unit vector; 1 to 10
    ground_albedo  of "hosek wilkie" alone: 0 to 1
    """

    key = "sky"
    label = "Sky"

    model: str = "multiple scattering"
    coordinates: object = GENERATED
    has_disk: bool = True
    sun_size: float = 0.0095
    sun_intensity: float = 1.0
    sun_elevation: float = 0.2618
    sun_rotation: float = 0.0
    altitude: float = 100.0
    air: float = 1.0
    haze: float = 1.0
    ozone: float = 1.0
    sun_direction: tuple = (0.0, 0.0, 1.0)
    turbidity: float = 2.2
    ground_albedo: float = 0.3

    def check(self, owner):
        if self.model not in MODELS:
            raise SceneError(f"{owner}: the model of a sky is {self.model!r}, allowed: {', '.join(MODELS)}")
        ranges = {
            "sun_size": (np.finfo(np.float32).tiny, 0.5 * np.pi),
            "sun_intensity": (0, np.inf),
            "sun_elevation": (-0.5 * np.pi, 0.5 * np.pi),
            "sun_rotation": (-np.inf, np.inf),
            "altitude": (-np.inf, np.inf),
            "air": (0, np.inf),
            "haze": (0, np.inf),
            "ozone": (0, np.inf),
            "turbidity": (1, 10),
            "ground_albedo": (0, 1),
        }
        for name, (least, most) in ranges.items():
            value = getattr(self, name)
            if not (np.isfinite(value) and np.float32(least) <= np.float32(value) <= np.float32(most)):
                raise SceneError(f"{owner}: {name} of a sky is {value}, allowed: finite numbers, {least:.4g} to {most:.4g}")
        if not np.isfinite(self.sun_direction).all():
            raise SceneError(f"{owner}: sun_direction of a sky is {tuple(self.sun_direction)}, allowed: a unit vector")

    def eval(self, at):
        d, _ = at.look_up(self.coordinates)
        if self.model == "preetham":
            return preetham(d, self.sun_direction, self.turbidity)
        if self.model == "hosek wilkie":
            return hosek_wilkie(d, self.sun_direction, self.turbidity, self.ground_albedo)
        sky = self._scattered(d)
        if not self.has_disk:
            return sky
        inside, sun = self._sun(d)
        return np.where(inside, sun if self.model == "nishita" else sky + sun, sky)

    def spots(self):
        """Where the texture is much brighter than around: (unit vector (3,), radius [rad]) of each disk."""
        return ((self._towards(), 0.5 * self.sun_size),) if self.has_disk and self.model not in _SUNLESS else ()

    def _towards(self):
        flat = np.cos(self.sun_elevation)
        return np.array([flat * np.sin(self.sun_rotation), flat * np.cos(self.sun_rotation), np.sin(self.sun_elevation)])

    def _air(self):
        altitude = min(max(self.altitude, 1.0), _HIGHEST[self.model]) / 1000
        return altitude, self.air, self.haze, self.ozone

    def _scattered(self, d):
        """Radiance (3, N) without the sun."""
        table = _table(self.model, self.sun_elevation, *self._air())
        from_sun = np.arctan2(d[1], d[0]) - np.float32(0.5 * PI - self.sun_rotation)
        from_sun = np.abs(np.remainder(from_sun + PI, np.float32(2 * PI)) - PI)
        column = (PI - from_sun) * np.float32(_COLUMNS / PI) - np.float32(0.5)
        height = np.arcsin(np.clip(d[2], -1, 1)) / (0.5 * PI)
        if self.model != "nishita":
            row = (np.copysign(np.sqrt(np.abs(height)), height) + 1) * np.float32(_ROWS) - np.float32(0.5)
            return _interpolated(table, row, column)
        row = np.sqrt(np.maximum(height, 0)) * np.float32(_ROWS) - np.float32(0.5)
        return _interpolated(table, row, column) * _faded(d[2])

    def _sun(self, d):
        """Whether d (3, N) are within the disk and above the ground (N,), and its radiance there (3, N)."""
        lower, upper = _disk(self.model, self.sun_elevation, self.sun_size, *self._air())
        half = 0.5 * self.sun_size
        towards = self._towards().astype(np.float32)[:, None]
        angle = 2 * np.arctan2(length(d - towards), length(d + towards))
        elevation = np.arcsin(np.clip(d[2], -1, 1))
        bottom = self.sun_elevation - half
        lowest = 0.0
        if self.model != "nishita":
            lowest = np.arcsin(atmosphere.EARTH / (atmosphere.EARTH + max(self.altitude, 0.0) / 1000)) - 0.5 * np.pi
        else:
            bottom = max(bottom, 0.0)
        height = (elevation - np.float32(bottom)) / np.float32(max(self.sun_elevation + half - bottom, np.finfo(np.float32).tiny))
        inside = (angle < half) & (elevation >= lowest)
        darker = 1 - _LIMB * (1 - np.sqrt(np.maximum(1 - (angle / np.float32(half)) ** 2, 0)))
        sun = lower[:, None] + (upper - lower)[:, None] * height
        return inside, np.maximum(sun, 0) * (np.float32(self.sun_intensity) * darker)


@lru_cache(maxsize=8)
def _table(model, sun_elevation, altitude, air, haze, ozone):
    """The sky (3, H, W) float32: from below up, from opposite the sun to the sun."""
    air = altitude, air, haze, ozone
    if model == "multiple scattering":
        azimuths = np.pi - (np.arange(_COLUMNS) + 0.5) * (np.pi / _COLUMNS)
        height = (np.arange(2 * _ROWS) + 0.5) / _ROWS - 1
        elevations = np.copysign(height**2, height) * (0.5 * np.pi)
        return atmosphere.multiple_scattering(elevations, azimuths, sun_elevation, *air).astype(np.float32)
    azimuths = np.pi - np.arange(_COLUMNS) * (np.pi / _COLUMNS)
    elevations = (np.arange(_ROWS) / _ROWS) ** 2 * (0.5 * np.pi)
    if model == "nishita":
        elevations *= 1 + 0.5 / _ROWS
    above = scattering.single_scattering(elevations, azimuths, sun_elevation, *air).astype(np.float32)
    if model == "nishita":
        return above
    below = -((np.arange(_ROWS) / _ROWS - 1) ** 2) * (0.5 * np.pi)
    return np.concatenate((above[:, :1] * _faded(np.sin(below).astype(np.float32))[:, None], above), axis=1)


def _faded(z):
    """The share of the horizon's light that comes from the ground, in directions of this z (N,)."""
    return np.clip(1 + np.float32(2.5) * z, 0, 1) ** 3


@lru_cache(maxsize=8)
def _disk(model, sun_elevation, size, altitude, air, haze, ozone):
    """Radiance at the lower and upper edge of the sun, each (3,) float32."""
    if model == "multiple scattering":
        edges = atmosphere.sun_disk(sun_elevation, size, altitude, air, haze, ozone)
    else:
        edges = scattering.sun_disk(sun_elevation, size, altitude, air, haze)
    return tuple(edge.astype(np.float32) for edge in edges)


def _interpolated(table, row, column):
    """The table at places (N,), bilinear, the same beyond its edges; nothing is below 0."""
    _, height, width = table.shape
    row, column = (np.clip(a, 0, n - 1) for a, n in ((row, height), (column, width)))
    i, j = (np.minimum(a.astype(np.intp), n - 2) for a, n in ((row, height), (column, width)))
    a, b = (row - i).astype(np.float32), (column - j).astype(np.float32)
    at = i * width + j
    # What is no place has some entry.
    taken = partial(table.reshape(3, -1).take, axis=1, mode="clip")
    lower, upper = ((1 - b) * taken(at + k) + b * taken(at + k + 1) for k in (0, width))
    return np.maximum((1 - a) * lower + a * upper, 0)
