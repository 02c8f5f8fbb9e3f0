"""The pinhole camera: everything sharp, straight lines straight."""

import math
from dataclasses import dataclass, field

import numpy as np

from ..errors import SceneError
from ..maths.transforms import look_at
from . import registry


@registry.add
@dataclass(frozen=True, kw_only=True, eq=False)
class PerspectiveCamera:
    """A pinhole at the origin of its frame that looks along -z, x to the right, y up.

    world_from_camera  (4, 4), a rotation and a translation [m]
    window             (left, right, bottom, top) of the image plane at distance 1, where the full frame is seen;
                       not centred for a shifted lens
    """

    key = "perspective"
    label = "Perspective"

    name: str = "Camera"
    world_from_camera: np.ndarray = field(default_factory=lambda: np.eye(4))
    window: tuple = (-0.5, 0.5, -0.5, 0.5)

    @classmethod
    def look_at(cls, eye, target, up=(0.0, 0.0, 1.0), fov=math.radians(40), aspect=1.0, name="Camera"):
        """At `eye` [m], looking at `target` [m]; `fov` is the vertical field of view [rad], `aspect` width over height."""
        try:
            matrix = look_at(eye, target, up)
        except ValueError as error:
            raise SceneError(f"camera '{name}': {error}") from None
        top = math.tan(0.5 * fov)
        return cls(name=name, world_from_camera=matrix, window=(-top * aspect, top * aspect, -top, top))

    def check(self):
        left, right, bottom, top = self.window
        if not (left < right and bottom < top and math.isfinite(right - left) and math.isfinite(top - bottom)):
            raise SceneError(f"camera '{self.name}': window is {self.window}, allowed: finite, left < right and bottom < top")

    @property
    def position(self):
        """World space [m], (3,) float64: what the world is centred on."""
        return np.asarray(self.world_from_camera, np.float64)[:3, 3]

    def row(self, width, height):
        """The axes of a pixel grid of `width` x `height`, in world orientation: middle, right and down per pixel."""
        left, right, bottom, top = self.window
        u, v, w = np.asarray(self.world_from_camera, np.float64)[:3, :3].T
        return {
            "middle": tuple(0.5 * (left + right) * u + 0.5 * (bottom + top) * v - w),
            "right": tuple((right - left) / width * u),
            "down": tuple((bottom - top) / height * v),
            "centre_x": 0.5 * width,
            "centre_y": 0.5 * height,
            "axis": tuple(-w),
        }

    @staticmethod
    def rays(k, x, y):
        """Origins and directions (3, N) through film positions x, y (N,) [px], measured from the middle of the frame.

        Render space is centred on the pinhole, so every origin is 0. Direction s / |s| with
        s = u_c u + v_c v - w (lecture, pinhole camera).
        """
        s = k.middle + x * k.right + y * k.down
        s /= np.sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2])
        return np.zeros_like(s), s
