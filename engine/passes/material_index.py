"""Which materials are seen, by numbers of their own."""

from . import registry


@registry.add
class MaterialIndex:
    """The index of the material that the first sample meets; 0 where there is none."""

    key = "Material Index"
    label = "Material Index"
    channels = "X"
    records = "first hit"
    reduction = "first"
    divided_by = ""
    background = 0.0

    @staticmethod
    def values(plan, rays, surface, reflection):
        return plan.world.materials.index.take(surface.material)[None]
