"""Which materials are seen, by numbers of their own."""

from ..wavefront.recording import FirstHit
from . import registry


@registry.add
class MaterialIndex(FirstHit):
    """The index of the material that the first sample meets; 0 where there is none."""

    key = "Material Index"
    label = "Material Index"
    channels = "X"
    reduction = "first"

    @staticmethod
    def values(plan, rays, surface, reflection):
        return plan.world.materials.index.take(surface.material)[None]
