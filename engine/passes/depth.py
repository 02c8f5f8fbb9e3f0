"""How far away things are."""

from ..maths.vectors import dot
from . import registry


@registry.add
class Depth:
    """Distance along the camera's axis [m] of what the first sample meets; 1e10 where it meets nothing, as Cycles'."""

    key = "Depth"
    label = "Depth"
    channels = "Z"
    at_first_hit = True
    is_average = False
    background = 1e10

    @staticmethod
    def values(plan, surface):
        axis = plan.camera_k.axis
        return dot(surface.p, axis)[None] / plan.world.frame.scale

    @staticmethod
    def gather(radiance, first_hits):
        return first_hits
