"""Light from a flat shape, into the half space that it faces."""

import math
from dataclasses import dataclass, field

import numpy as np

from ..constants import PI
from ..errors import SceneError
from ..maths.vectors import dot
from ..maths.warps import CENTRE, square_to_disk
from ..scene.shade import Shade
from . import registry


@registry.add
@dataclass(frozen=True, kw_only=True, eq=False)
class AreaLight:
    """A rectangle or ellipse in the xy plane of its own frame that shines along -z.

    world_from_light  (4, 4); its scale changes the size
    size_x, size_y    full width and height in the light's frame [m]
    is_ellipse        an ellipse that fills the rectangle
    radiance          [W m^-2 sr^-1], (r, g, b), on the axis
    spread            full angle [rad] in (0, pi] into which it shines; below pi, radiance falls with the angle as
                      behind a grid: max(tan a - tan theta, 0) / (tan a - a), a = spread / 2, so the flux stays
    is_visible        camera rays see the shape
    hidden_from       kinds of scattered rays, of `RAY_KINDS`, that it gives no light to
    shade             the `Shade` that its light passes; None: it shines as above
    group             the light group that it belongs to; empty: none
    """

    key = "area"
    label = "Area"

    name: str = "Area"
    world_from_light: np.ndarray = field(default_factory=lambda: np.eye(4))
    size_x: float = 1.0
    size_y: float = 1.0
    is_ellipse: bool = False
    radiance: tuple = (1.0, 1.0, 1.0)
    spread: float = math.pi
    is_visible: bool = False
    shade: Shade | None = None
    group: str = ""
    hidden_from: tuple = ()

    def _axes(self):
        matrix = np.asarray(self.world_from_light, np.float64)
        with np.errstate(over="ignore"):
            return matrix[:3, 0] * self.size_x, matrix[:3, 1] * self.size_y

    def area(self):
        """World-space area [m^2]."""
        share = 0.25 * PI if self.is_ellipse else 1.0
        with np.errstate(over="ignore", invalid="ignore"):
            return share * float(np.linalg.norm(np.cross(*self._axes())))

    def _normal(self):
        normal = -np.cross(*self._axes())
        if normal @ np.asarray(self.world_from_light, np.float64)[:3, 2] > 0:
            normal = -normal  # a mirrored frame: the light still shines along its -z
        norm = np.linalg.norm(normal)
        return tuple(normal / norm if norm > 0 else normal)

    def _gain(self):
        """The factor (tan a) / (tan a - a) of the radiance on the axis, and cot a: finite for a = pi / 2, where the light is Lambertian."""
        if self.spread >= PI:
            return 1.0, 0.0
        half = 0.5 * self.spread
        cot = math.cos(half) / math.sin(half)
        return 1 / (1 - half * cot) if half > 0.05 else 3 / (half * half) - 0.2, cot

    def row(self, frame):
        x, y = self._axes()
        gain, cot = self._gain()
        return {
            "centre": tuple(frame.points(np.asarray(self.world_from_light, np.float64)[:3, 3:4])[:, 0]),
            "axis_x": tuple(x * frame.scale),
            "axis_y": tuple(y * frame.scale),
            "normal": self._normal(),
            "area": self.area() * frame.scale**2,
            "ellipse": float(self.is_ellipse),
            "radiance": self.radiance,
            "cot_spread": cot,
            "gain": gain,
        }

    def power(self, radius=1.0):
        """Radiant flux [W], (r, g, b): pi A L."""
        return tuple(PI * self.area() * c for c in self.radiance)

    def check(self):
        if not (self.size_x >= 0 and self.size_y >= 0 and 0 < self.spread <= PI):
            raise SceneError(
                f"light '{self.name}': size {self.size_x} x {self.size_y} m, spread {self.spread} rad; allowed: from 0 on, above 0 to pi"
            )

    def weight(self, frame):
        x, y = self._axes()
        return {
            "centre": tuple(frame.points(np.asarray(self.world_from_light, np.float64)[:3, 3:4])[:, 0]),
            "power": tuple(self._gain()[0] * self.area() * frame.scale**2 * c for c in self.radiance),
            "nearness": 1.0,
            "axis": self._normal(),
            "cos_edge": max(math.cos(0.5 * self.spread), 0.0),
            "radius2": 0.25 * float(x @ x + y @ y) * frame.scale**2,
        }

    def has_extent(self):
        return self.area() > 0

    @staticmethod
    def sample(k, p, u2):
        x, y = _place(k, u2)
        to_light = k.centre + x * k.axis_x + y * k.axis_y - p
        distance2 = dot(to_light, to_light)
        distance = np.sqrt(distance2)
        tiny = np.finfo(distance.dtype).tiny
        wi = to_light / np.maximum(distance, tiny)
        cos = np.maximum(-dot(wi, k.normal), 0)
        geometry = k.area * cos / np.maximum(distance2, tiny)
        with np.errstate(divide="ignore"):
            pdf = 1 / geometry
        return wi, distance, _radiance(k, cos) * geometry, pdf

    @staticmethod
    def middle(k):
        return np.where(k.ellipse > 0, CENTRE, np.float32(0.5))

    @staticmethod
    def hit(k, o, d):
        cos = -dot(d, k.normal)
        facing = cos > 0
        to_centre = k.centre - o
        t = -dot(to_centre, k.normal) / np.where(facing, cos, 1)
        offset = t * d - to_centre
        x = dot(offset, k.axis_x) / np.maximum(dot(k.axis_x, k.axis_x), np.finfo(np.float32).tiny)
        y = dot(offset, k.axis_y) / np.maximum(dot(k.axis_y, k.axis_y), np.finfo(np.float32).tiny)
        within = np.where(k.ellipse > 0, x * x + y * y < 0.25, np.maximum(np.abs(x), np.abs(y)) < 0.5)
        meets = facing & within & (t > 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            pdf = t * t / (k.area * np.maximum(cos, 0))
        return np.where(meets, t, np.inf), _radiance(k, cos), pdf

    @staticmethod
    def seen(k, p, d, distance):
        place = p + d * distance
        offset = place - k.centre
        u, v = (dot(offset, axis) / np.maximum(dot(axis, axis), np.finfo(offset.dtype).tiny) for axis in (k.axis_x, k.axis_y))
        return place, np.broadcast_to(k.normal, place.shape), np.stack((u, v)) + np.float32(0.5)


def _place(k, u2):
    """Points on the shape, as shares of its width and height in [-1/2, 1/2]."""
    if not k.ellipse.any():
        return u2 - 0.5
    disk = 0.5 * square_to_disk(u2)
    return disk if k.ellipse.all() else np.where(k.ellipse > 0, disk, u2 - 0.5)


def _radiance(k, cos):
    if not k.cot_spread.any():  # Lambertian, as nearly all are
        return k.radiance
    # gain * (1 - tan(theta) cot(a))
    cos = np.clip(cos, 0, 1)
    tan = np.sqrt(1 - cos * cos) / np.where(cos > 0, cos, 1)
    return k.radiance * (k.gain * np.maximum(1 - tan * k.cot_spread, 0))
