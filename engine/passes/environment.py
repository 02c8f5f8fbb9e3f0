"""Light that reaches the camera straight from the world."""

from ..wavefront.recording import OfLight
from ..wavefront.splitting import is_of_world
from . import registry


@registry.add
class Environment(OfLight):
    """Light of the world, where the camera sees it [W m^-2 sr^-1]."""

    key = "Environment"
    label = "Environment"
    channels = "RGB"

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return L * is_of_world(plan, light) if bounces == 0 else 0
