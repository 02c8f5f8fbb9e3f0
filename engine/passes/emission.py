"""Light that reaches the camera straight from what shines in the scene."""

from ..wavefront.recording import OfLight
from ..wavefront.splitting import is_of_world
from . import registry


@registry.add
class Emission(OfLight):
    """Light of glowing surfaces and of lamps, where the camera sees them [W m^-2 sr^-1]."""

    key = "Emission"
    label = "Emission"
    channels = "RGB"

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return L * ~is_of_world(plan, light) if bounces == 0 else 0
