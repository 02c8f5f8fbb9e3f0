"""A point light that shines into a cone with a soft edge, as Blender's."""

import math
from dataclasses import dataclass, field

import numpy as np

from ..errors import SceneError
from ..maths import bulbs
from ..maths.vectors import dot, normalize
from ..scene.shade import Shade
from . import registry


@registry.add
@dataclass(frozen=True, kw_only=True, eq=False)
class SpotLight:
    """A bulb seen through a cone about -z of its own frame.

    world_from_light  (4, 4); its scale stretches the cone, its translation is the position [m]
    intensity         radiant intensity on the axis [W sr^-1], (r, g, b); a narrower cone does not raise it
    angle             full opening [rad], in (0, pi]
    blend             share of the cone over which the edge fades, 0: hard, 1: from the axis on
    radius            of the bulb [m]; 0: a point
    soft_falloff      the bulb is a disk facing whatever it lights (Blender's default); else a sphere
    is_visible        camera rays see the bulb
    hidden_from       kinds of scattered rays, of `RAY_KINDS`, that it gives no light to
    shade             the `Shade` that its light passes; None: it shines as above
    group             the light group that it belongs to; empty: none

    The edge is Blender's: smoothstep((cos theta - cos(angle / 2)) / ((1 - cos(angle / 2)) blend)).
    """

    key = "spot"
    label = "Spot"

    name: str = "Spot"
    world_from_light: np.ndarray = field(default_factory=lambda: np.eye(4))
    intensity: tuple = (1.0, 1.0, 1.0)
    angle: float = math.pi / 4
    blend: float = 0.15
    radius: float = 0.0
    soft_falloff: bool = True
    is_visible: bool = False
    shade: Shade | None = None
    group: str = ""
    hidden_from: tuple = ()

    @property
    def position(self):
        """World space [m]."""
        return tuple(np.asarray(self.world_from_light, np.float64)[:3, 3])

    def row(self, frame):
        # Rows of the inverse of a rotation with scale are the columns over their squared lengths; no inverse needed.
        axes = np.asarray(self.world_from_light, np.float64)[:3, :3]
        squared = (axes * axes).sum(axis=0)
        x, y, z = (axes / np.where(squared > 0, squared, 1)).T
        cos_edge = math.cos(0.5 * self.angle)
        return bulbs.row(frame, self) | {
            "axis_x": tuple(x),
            "axis_y": tuple(y),
            "axis_z": tuple(z),
            "cos_edge": cos_edge,
            "fade": (1 - cos_edge) * self.blend,
        }

    def power(self, radius=1.0):
        """An upper bound of the radiant flux [W], (r, g, b), by which lights are chosen."""
        share = 0.5 * (1 - math.cos(0.5 * self.angle))
        return tuple(share * c for c in bulbs.power(self))

    def check(self):
        bulbs.check(self)
        if not (0 < self.angle <= math.pi and 0 <= self.blend <= 1):
            raise SceneError(f"light '{self.name}': angle {self.angle} rad, blend {self.blend}; allowed: 0 to pi, 0 to 1")

    def weight(self, frame):
        z = np.asarray(self.world_from_light, np.float64)[:3, 2]
        axis = -z / (np.linalg.norm(z) or 1.0)
        return bulbs.weight(frame, self) | {"axis": tuple(axis), "cos_edge": math.cos(0.5 * self.angle)}

    def has_extent(self):
        return self.radius > 0

    @staticmethod
    def sample(k, p, u2):
        wi, distance, E, pdf = bulbs.sample(k, p, u2)
        return wi, distance, E * falloff(k, wi), pdf

    @staticmethod
    def middle(k):
        return bulbs.MIDDLE

    @staticmethod
    def hit(k, o, d):
        t, L, pdf = bulbs.hit(k, o, d)
        return t, L * falloff(k, d), pdf

    @staticmethod
    def seen(k, p, d, distance):
        place, n, _ = bulbs.seen(k, p, d, distance)
        # The cone fills the square, however wide it is (as in Cycles).
        x, y, z = (dot(axis, d) for axis in (k.axis_x, k.axis_y, k.axis_z))
        reach = 0.5 * k.cos_edge / (z * np.sqrt(1 - k.cos_edge * k.cos_edge))
        return place, n, np.float32(0.5) - np.stack((x * reach, y * reach))


def falloff(k, towards_light):
    """The share of the intensity that passes the cone against the direction `towards_light` (3, N), in [0, 1]."""
    local = np.stack(np.broadcast_arrays(*(dot(axis, towards_light) for axis in (k.axis_x, k.axis_y, k.axis_z))))
    cos = normalize(local)[2]
    hard = k.fade <= 0
    x = np.clip((cos - k.cos_edge) / np.where(hard, 1, k.fade), 0, 1)
    return np.where(hard, cos > k.cos_edge, x * x * (3 - 2 * x)).astype(towards_light.dtype, copy=False)
