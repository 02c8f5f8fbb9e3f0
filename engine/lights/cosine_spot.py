"""A spot light as the lecture has it: its intensity is a power of the cosine from the axis."""

from dataclasses import dataclass, field

import numpy as np

from ..constants import PI
from ..maths import bulbs
from ..maths.lobes import check_exponent
from ..maths.vectors import cosine_power
from ..scene.shade import Shade
from . import registry


@registry.add
@dataclass(frozen=True, kw_only=True, eq=False)
class CosineSpotLight:
    """A bulb with the characteristic I = I_0 max(cos theta, 0)^n about -z of its own frame (C. Dachsbacher, Computergrafik).

    world_from_light  (4, 4); its translation is the position [m], its scale means nothing
    intensity         I_0, radiant intensity on the axis [W sr^-1], (r, g, b); a sharper characteristic does not raise it
    exponent          n in [0, 1e6]: 0 lights the half space in front evenly, 1 as a small Lambertian lamp, large is a beam
    radius            of the bulb [m]; 0: a point
    soft_falloff      the bulb is a disk facing whatever it lights (Blender's default); else a sphere
    is_visible        camera rays see the bulb
    hidden_from       kinds of scattered rays, of `RAY_KINDS`, that it gives no light to
    shade             the `Shade` that its light passes; None: it shines as above
    group             the light group that it belongs to; empty: none
    """

    key = "cosine_spot"
    label = "Spot (Lecture)"

    name: str = "Spot"
    world_from_light: np.ndarray = field(default_factory=lambda: np.eye(4))
    intensity: tuple = (1.0, 1.0, 1.0)
    exponent: float = 8.0
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

    @property
    def axis(self):
        """Unit vector along which the light is brightest, world space."""
        z = np.asarray(self.world_from_light, np.float64)[:3, 2]
        return tuple(-z / (np.linalg.norm(z) or 1.0))

    def row(self, frame):
        return bulbs.row(frame, self) | {"axis": self.axis, "exponent": self.exponent}

    def power(self, radius=1.0):
        """Radiant flux [W], (r, g, b): 2 pi I_0 / (n + 1)."""
        return tuple(2 * PI / (self.exponent + 1) * c for c in self.intensity)

    def check(self):
        bulbs.check(self)
        check_exponent(f"light '{self.name}': exponent", self.exponent)

    def weight(self, frame):
        return bulbs.weight(frame, self) | {"axis": self.axis, "cos_edge": 0.0}

    def has_extent(self):
        return self.radius > 0

    @staticmethod
    def sample(k, p, u2):
        wi, distance, E, pdf = bulbs.sample(k, p, u2)
        return wi, distance, E * cosine_power(k.axis, -wi, k.exponent), pdf

    @staticmethod
    def middle(k):
        return bulbs.MIDDLE

    @staticmethod
    def hit(k, o, d):
        t, L, pdf = bulbs.hit(k, o, d)
        return t, L * cosine_power(k.axis, -d, k.exponent), pdf

    @staticmethod
    def seen(k, p, d, distance):
        return bulbs.seen(k, p, d, distance)
