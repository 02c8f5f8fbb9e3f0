"""Which way surfaces face."""

from . import registry


@registry.add
class Normal:
    """The shading normal in world space, on the viewer's side, averaged; 0 where nothing is met."""

    key = "Normal"
    label = "Normal"
    channels = "XYZ"
    at_first_hit = True
    reduction = "mean"
    background = 0.0

    @staticmethod
    def values(plan, rays, surface):
        return surface.ns

    @staticmethod
    def gather(radiance, first_hits):
        return first_hits
