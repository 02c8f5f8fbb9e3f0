"""Which objects are seen, by numbers of their own."""

from ..wavefront.recording import FirstHit
from . import registry

_INDEX = ("value", "index")


@registry.add
class ObjectIndex(FirstHit):
    """The value "index" of the object that the first sample meets; 0 where there is none."""

    key = "Object Index"
    label = "Object Index"
    channels = "X"
    reduction = "first"
    attributes = (_INDEX,)

    @staticmethod
    def values(plan, rays, surface, reflection):
        return plan.world.attributes[_INDEX].at(surface.prim, surface.u, surface.v)[0][:1]
