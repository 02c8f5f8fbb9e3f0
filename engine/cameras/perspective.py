"""The pinhole camera, and the thin lens: straight lines straight."""

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
class PerspectiveCamera:
    """A pinhole, or the middle of a lens, at the origin of its frame that looks along -z, x to the right, y up.

    world_from_camera     (4, 4), a rotation and a translation [m]
    window                (left, right, bottom, top) of the image plane at distance 1, where the full frame is seen;
                          not centred for a shifted lens
    clip_start, clip_end  camera rays meet only what is so far away along the axis [m]
    lens                  a `Lens`; the default is a pinhole
    motion                (K, 4, 4) world_from_camera at equally spaced times, the first and the last included, while the shutter
                          is open; none (0, 4, 4): it stands still. `world_from_camera` is then set to the middle
    """

    key = "perspective"
    label = "Perspective"

    name: str = "Camera"
    world_from_camera: np.ndarray = field(default_factory=lambda: np.eye(4))
    window: tuple = (-0.5, 0.5, -0.5, 0.5)
    clip_start: float = 0.0
    clip_end: float = math.inf
    lens: Lens = PINHOLE
    motion: np.ndarray = field(default_factory=no_motion)

    def __post_init__(self):
        settle(self, "camera", "world_from_camera")

    @classmethod
    def look_at(cls, eye, target, up=(0.0, 0.0, 1.0), fov=math.radians(40), aspect=1.0, name="Camera", **others):
        """At `eye` [m], looking at `target` [m]; `fov` is the vertical field of view [rad], `aspect` width over height."""
        try:
            matrix = look_at(eye, target, up)
        except ValueError as error:
            raise SceneError(f"camera '{name}': {error}") from None
        top = math.tan(0.5 * fov)
        return cls(name=name, world_from_camera=matrix, window=(-top * aspect, top * aspect, -top, top), **others)

    def check(self):
        left, right, bottom, top = self.window
        if not (left < right and bottom < top and math.isfinite(right - left) and math.isfinite(top - bottom)):
            raise SceneError(f"camera '{self.name}': window is {self.window}, allowed: finite, left < right and bottom < top")

    @property
    def position(self):
        """World space [m], (3,) float64: what the world is centred on."""
        return np.asarray(self.world_from_camera, np.float64)[:3, 3]

    def in_window(self, p):
        left, right, bottom, top = self.window
        return (p[0] / p[2] - left) / (right - left), (p[1] / p[2] - bottom) / (top - bottom)

    def row(self, width, height, scale=1.0):
        """The axes of a pixel grid of `width` x `height`, in world orientation: middle, right and down per pixel."""
        left, right, bottom, top = self.window
        u, v, w = np.asarray(self.world_from_camera, np.float64)[:3, :3].T
        return {
            "middle": tuple(0.5 * (left + right) * u + 0.5 * (bottom + top) * v - w),
            "right": tuple((right - left) / width * u),
            "down": tuple((bottom - top) / height * v),
            "u": tuple(u),
            "v": tuple(v),
            "axis": tuple(-w),
            **self.lens.row(scale),
        }

    @staticmethod
    def rays(k, x, y):
        """Origins and directions (3, N) through film positions x, y (N,) [px], measured from the middle of the frame.

        Render space is centred on the pinhole, so every origin is 0. Direction s / |s| with
        s = u_c u + v_c v - w (lecture, pinhole camera).
        """
        s = k.middle + x * k.right + y * k.down
        s /= length(s)
        return np.zeros_like(s), s

    @staticmethod
    def lens_rays(k, x, y, lens):
        """As `rays`, from points `lens` (2, N) of the aperture: through the point F s where the pinhole's ray is in focus.

        F s - o, over the focus distance F, is s - o / F: the pinhole's own ray, to the bit, where o is 0.
        """
        s = k.middle + x * k.right + y * k.down
        o = lens[0] * k.u + lens[1] * k.v
        s -= o * k.per_focus
        s /= length(s)
        return o, s

    @staticmethod
    def depth(k, p):
        """How far p (3, N) is away, (N,): along the axis."""
        return dot(p, k.axis)

    @staticmethod
    def distance(k, p):
        """How far p (3, N) is away for mist, (N,): in a straight line."""
        return length(p)

    @staticmethod
    def ray_per_depth(k, d):
        """Length of rays along d (3, N) per unit of depth, (N,)."""
        return 1 / dot(d, k.axis)
