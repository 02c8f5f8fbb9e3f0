"""Light from so far away that it is the same everywhere."""

import math
from dataclasses import dataclass

import numpy as np

from ..constants import PI
from ..errors import SceneError
from ..maths.frames import to_world
from ..maths.light_frames import to_light
from ..maths.vectors import dot, length
from ..maths.warps import CENTRE, square_to_cone, square_to_cone_pdf
from ..scene.shade import Shade
from . import registry


@registry.add
@dataclass(frozen=True, kw_only=True)
class SunLight:
    """A distant disk.

    towards     unit vector to the middle of the disk, world space
    irradiance  on a surface that faces it [W m^-2], (r, g, b)
    angle       angular diameter [rad], in [0, pi]; 0: a direction
    is_visible  camera rays see the disk
    hidden_from kinds of scattered rays, of `RAY_KINDS`, that it gives no light to
    shade       the `Shade` that its light passes; None: it shines as above
    group       the light group that it belongs to; empty: none

    The disk has the radiance E / (pi sin^2(angle / 2)).
    """

    key = "sun"
    label = "Sun"
    is_distant = True

    name: str = "Sun"
    towards: tuple = (0.0, 0.0, 1.0)
    irradiance: tuple = (1.0, 1.0, 1.0)
    angle: float = 0.0
    is_visible: bool = False
    shade: Shade | None = None
    group: str = ""
    hidden_from: tuple = ()

    def row(self, frame):
        half = 0.5 * self.angle
        sin2 = math.sin(half) ** 2
        return {
            "towards": self.towards,
            "one_minus_cos": 2 * math.sin(0.5 * half) ** 2,
            # L / pdf = E / (pi sin^2) * 2 pi (1 - cos) = 2 E / (1 + cos)
            "irradiance": tuple(2 * c / (1 + math.cos(half)) for c in self.irradiance),
            "radiance": tuple(c / (PI * sin2) if sin2 > 0 else 0.0 for c in self.irradiance),
        }

    def power(self, radius=1.0):
        """The flux [W], (r, g, b), through the cross-section of a scene of `radius` [m]: pi r^2 E."""
        return tuple(PI * radius**2 * c for c in self.irradiance)

    def check(self):
        if not 0 <= self.angle <= math.pi:
            raise SceneError(f"light '{self.name}': angle is {self.angle} rad, allowed: 0 to pi")

    def weight(self, frame):
        nowhere = (0.0, 0.0, 0.0)
        return {"centre": nowhere, "power": self.irradiance, "nearness": 0.0, "radius2": 1.0, "axis": nowhere, "cos_edge": -1.0}

    def has_extent(self):
        return self.angle > 0

    @staticmethod
    def sample(k, p, u2):
        wi = to_world(k.towards, square_to_cone(u2, k.one_minus_cos))
        everywhere = np.ones_like(p[0])
        return wi, everywhere * np.inf, k.irradiance * everywhere, square_to_cone_pdf(k.one_minus_cos) * everywhere

    @staticmethod
    def middle(k):
        return CENTRE

    @staticmethod
    def hit(k, o, d):
        # |d - towards|^2 = 2 (1 - cos): no cancellation for a small disk.
        apart = d - k.towards
        inside = 0.5 * dot(apart, apart) < k.one_minus_cos
        farthest = np.finfo(d.dtype).max
        return np.where(inside, farthest, np.inf).astype(d.dtype), k.radiance, square_to_cone_pdf(k.one_minus_cos)

    @staticmethod
    def seen(k, p, d, distance):
        # The disk fills the square (as in Cycles), a direction is its middle.
        x, y, _ = to_light(k, d)
        scale = np.sqrt(2 * k.one_minus_cos) * length(d + k.towards)
        u, v = (np.divide(a, scale, out=np.zeros_like(a), where=scale > 0) for a in (x, y))
        return -d, -d, np.stack((u, v)) + np.float32(0.5)
