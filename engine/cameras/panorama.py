"""The panorama camera: all around, on a map."""

import math
from dataclasses import dataclass, field

import numpy as np

from ..errors import SceneError
from ..maths.vectors import cross, dot, length, normalize
from ..scene.lens import PINHOLE, Lens
from ..scene.motion import no_motion, settle
from . import registry


@registry.add
@dataclass(frozen=True, kw_only=True, eq=False)
class PanoramaCamera:
    """An equirectangular map of directions: longitude across the frame, latitude up.

    It stands at the origin of its frame, looks along -z in the middle of its full map, x to the right, y to the north.

    world_from_camera     (4, 4), a rotation and a translation [m]
    longitude             (left, right) of the frame [rad]; 0 is ahead, positive to the right
    latitude              (bottom, top) of the frame [rad]; 0 is the horizon, positive up
    clip_start, clip_end  camera rays meet only what is so far away along the ray [m]
    lens                  a `Lens`, across every ray; the default is a pinhole
    motion                (K, 4, 4) world_from_camera at equally spaced times, the first and the last included, while the shutter
                          is open; none (0, 4, 4): it stands still. `world_from_camera` is then set to the middle
    """

    key = "panorama"
    label = "Panorama"

    name: str = "Camera"
    world_from_camera: np.ndarray = field(default_factory=lambda: np.eye(4))
    longitude: tuple = (-math.pi, math.pi)
    latitude: tuple = (-0.5 * math.pi, 0.5 * math.pi)
    clip_start: float = 0.0
    clip_end: float = math.inf
    lens: Lens = PINHOLE
    motion: np.ndarray = field(default_factory=no_motion)

    def __post_init__(self):
        settle(self, "camera", "world_from_camera")

    def check(self):
        for name, (low, high) in (("longitude", self.longitude), ("latitude", self.latitude)):
            if not (low < high and math.isfinite(high - low)):
                raise SceneError(f"camera '{self.name}': {name} is {low} to {high}, allowed: finite, the first less than the second")

    @property
    def position(self):
        """World space [m], (3,) float64: what the world is centred on."""
        return np.asarray(self.world_from_camera, np.float64)[:3, 3]

    def in_window(self, p):
        (left, right), (bottom, top) = self.longitude, self.latitude
        longitude, latitude = np.arctan2(p[0], p[2]), np.arctan2(p[1], np.hypot(p[0], p[2]))
        return (longitude - left) / (right - left), (latitude - bottom) / (top - bottom)

    def row(self, width, height, scale=1.0):
        """The map for a frame of `width` x `height`: its middle, angles per pixel, and the axes in world orientation."""
        (left, right), (bottom, top) = self.longitude, self.latitude
        u, v, w = np.asarray(self.world_from_camera, np.float64)[:3, :3].T
        return {
            "longitude": 0.5 * (left + right),
            "latitude": 0.5 * (bottom + top),
            "per_x": (right - left) / width,
            "per_y": (bottom - top) / height,
            "u": tuple(u),
            "v": tuple(v),
            "axis": tuple(-w),
            **self.lens.row(scale),
        }

    @staticmethod
    def rays(k, x, y):
        """Origins and directions (3, N) through film positions x, y (N,) [px], measured from the middle of the frame."""
        longitude, latitude = k.longitude + x * k.per_x, k.latitude + y * k.per_y
        d = np.sin(longitude) * k.u + np.cos(longitude) * k.axis
        d *= np.cos(latitude)
        d += np.sin(latitude) * k.v
        d /= length(d)
        return np.zeros_like(d), d

    @staticmethod
    def lens_rays(k, x, y, lens):
        """As `rays`, from points `lens` (2, N) of an aperture across the ray, through the point of it that is in focus.

        Right on the aperture is where the axis of the camera is, as in Cycles.
        """
        _, d = PanoramaCamera.rays(k, x, y)
        right = normalize(k.axis - dot(k.axis, d) * d)
        o = lens[0] * right + lens[1] * cross(d, right)
        aimed = d - o * k.per_focus
        is_moved = o.any(axis=0)
        # Where the lens has no width d stays what it is, to the bit.
        return o, aimed / np.where(is_moved, length(aimed), 1)

    @staticmethod
    def depth(k, p):
        """How far p (3, N) is away, (N,): in a straight line."""
        return length(p)

    @staticmethod
    def distance(k, p):
        """How far p (3, N) is away for mist, (N,): in a straight line."""
        return length(p)

    @staticmethod
    def ray_per_depth(k, d):
        """Length of rays along d (3, N) per unit of depth, (N,): 1."""
        return np.ones_like(d[0])
