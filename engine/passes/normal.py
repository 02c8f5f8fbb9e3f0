"""Which way surfaces face."""

from . import registry


@registry.add
class Normal:
    """The shading normal in world space, on the viewer's side, averaged; 0 where nothing is met."""

    key = "Normal"
    label = "Normal"
    channels = "XYZ"
    records = "first hit"
    reduction = "mean"
    divided_by = ""
    background = 0.0

    @staticmethod
    def values(plan, rays, surface, reflection):
        return surface.ns
