"""Light from a point or a small bulb, falling with the square of the distance."""

from dataclasses import dataclass

from ..maths import bulbs
from ..scene.shade import Shade
from . import registry


@registry.add
@dataclass(frozen=True, kw_only=True)
class PointLight:
    """A point or bulb of equal intensity in all directions.

    position      world space [m]
    intensity     radiant intensity [W sr^-1], (r, g, b)
    radius        of the bulb [m]; 0: a point
    soft_falloff  the bulb is a disk that turns to face whatever it lights (Blender's default); else a sphere
    is_visible    camera rays see the bulb (Blender's lights are invisible to the camera by default)
    hidden_from   kinds of scattered rays, of `RAY_KINDS`, that it gives no light to
    shade         the `Shade` that its light passes; None: it shines as above
    group         the light group that it belongs to; empty: none
    """

    key = "point"
    label = "Point"

    name: str = "Point"
    position: tuple = (0.0, 0.0, 0.0)
    intensity: tuple = (1.0, 1.0, 1.0)
    radius: float = 0.0
    soft_falloff: bool = True
    is_visible: bool = False
    shade: Shade | None = None
    group: str = ""
    hidden_from: tuple = ()

    def row(self, frame):
        return bulbs.row(frame, self)

    def power(self, radius=1.0):
        """Radiant flux [W], (r, g, b): 4 pi I."""
        return bulbs.power(self)

    def check(self):
        bulbs.check(self)

    def weight(self, frame):
        return bulbs.weight(frame, self)

    def has_extent(self):
        return self.radius > 0

    @staticmethod
    def sample(k, p, u2):
        return bulbs.sample(k, p, u2)

    @staticmethod
    def middle(k):
        return bulbs.MIDDLE

    @staticmethod
    def hit(k, o, d):
        return bulbs.hit(k, o, d)

    @staticmethod
    def seen(k, p, d, distance):
        return bulbs.seen(k, p, d, distance)
