"""The orthographic camera: parallels stay parallel, and distance does not matter."""

import math
from dataclasses import dataclass, field

import numpy as np

from ..errors import SceneError
from ..maths.transforms import look_at
from ..maths.vectors import dot, length
from ..scene.lens import PINHOLE, Lens
from ..scene.motion import no_motion, settle
from . import registry


@registry.add
@dataclass(frozen=True, kw_only=True, eq=False)
class OrthographicCamera:
    """A plane through the origin of its frame that looks along -z, x to the right, y up.

    world_from_camera     (4, 4), a rotation and a translation [m]
    window                (left, right, bottom, top) of what is seen of the plane [m]; not centred for a shifted camera
    clip_start, clip_end  camera rays meet only what is so far away along the axis [m]; what is behind the plane is below 0
    lens                  a `Lens`, at every point of the plane; the default is a pinhole
    motion                (K, 4, 4) world_from_camera at equally spaced times, the first and the last included, while the shutter
                          is open; none (0, 4, 4): it stands still. `world_from_camera` is then set to the middle
    """

    least_clip_start = -math.inf
    key = "orthographic"
    label = "Orthographic"

    name: str = "Camera"
    world_from_camera: np.ndarray = field(default_factory=lambda: np.eye(4))
    window: tuple = (-1.0, 1.0, -1.0, 1.0)
    clip_start: float = 0.0
    clip_end: float = math.inf
    lens: Lens = PINHOLE
    motion: np.ndarray = field(default_factory=no_motion)

    def __post_init__(self):
        settle(self, "camera", "world_from_camera")

    @classmethod
    def look_at(cls, eye, target, up=(0.0, 0.0, 1.0), height=2.0, aspect=1.0, name="Camera", **others):
        """At `eye` [m], looking at `target` [m]; the frame is `height` [m] high, `aspect` is width over height."""
        try:
            matrix = look_at(eye, target, up)
        except ValueError as error:
            raise SceneError(f"camera '{name}': {error}") from None
        top = 0.5 * height
        return cls(name=name, world_from_camera=matrix, window=(-top * aspect, top * aspect, -top, top), **others)

    def check(self):
        left, right, bottom, top = self.window
        if not (left < right and bottom < top and math.isfinite(right - left) and math.isfinite(top - bottom)):
            raise SceneError(f"camera '{self.name}': window is {self.window}, allowed: finite, left < right and bottom < top")

    @property
    def position(self):
        """World space [m], (3,) float64: the middle of what is seen of the plane, where float32 is at its best."""
        left, right, bottom, top = self.window
        u, v, _, origin = np.asarray(self.world_from_camera, np.float64)[:3].T
        return origin + 0.5 * (left + right) * u + 0.5 * (bottom + top) * v

    def in_window(self, p):
        left, right, bottom, top = self.window
        return (p[0] - left) / (right - left), (p[1] - bottom) / (top - bottom)

    def row(self, width, height, scale=1.0):
        """The pixel grid of `width` x `height` in render space of `scale` [m^-1]: right and down per pixel, the axes."""
        left, right, bottom, top = self.window
        u, v, w = np.asarray(self.world_from_camera, np.float64)[:3, :3].T
        return {
            "right": tuple((right - left) / width * scale * u),
            "down": tuple((bottom - top) / height * scale * v),
            "u": tuple(u),
            "v": tuple(v),
            "axis": tuple(-w),
            **self.lens.row(scale),
        }

    @staticmethod
    def rays(k, x, y):
        """Origins and directions (3, N) through film positions x, y (N,) [px], measured from the middle of the frame."""
        o = x * k.right + y * k.down
        return o, np.broadcast_to(k.axis / length(k.axis), o.shape)

    @staticmethod
    def lens_rays(k, x, y, lens):
        """As `rays`, from points `lens` (2, N) of an aperture around each origin, through the point in focus before it."""
        offset = lens[0] * k.u + lens[1] * k.v
        o = x * k.right + y * k.down
        o += offset
        d = k.axis - offset * k.per_focus
        d /= length(d)
        return o, d

    @staticmethod
    def depth(k, p):
        """How far p (3, N) is away, (N,): along the axis."""
        return dot(p, k.axis)

    @staticmethod
    def distance(k, p):
        """How far p (3, N) is away for mist, (N,): along the axis."""
        return np.abs(dot(p, k.axis))

    @staticmethod
    def ray_per_depth(k, d):
        """Length of rays along d (3, N) per unit of depth, (N,)."""
        return 1 / dot(d, k.axis)
