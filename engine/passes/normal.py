"""Which way surfaces face."""

from ..wavefront.recording import FirstHit
from . import registry


@registry.add
class Normal(FirstHit):
    """The shading normal in world space, on the viewer's side, averaged; 0 where nothing is met."""

    key = "Normal"
    label = "Normal"
    channels = "XYZ"

    @staticmethod
    def values(plan, rays, surface, reflection):
        return surface.ns
