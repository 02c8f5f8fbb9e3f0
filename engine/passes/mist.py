"""How much of things is lost in the mist."""

from ..wavefront.recording import FirstHit
from . import registry


@registry.add
class MistShare(FirstHit):
    """How much is gone at the distance from the camera, as `Mist` of the world says; averaged over the pixel, 1 where nothing is met."""

    key = "Mist"
    label = "Mist"
    channels = "Z"
    background = 1.0

    @staticmethod
    def values(plan, rays, surface, reflection):
        p = plan.seen_from_camera(plan, rays, surface.p)
        return plan.scene.world.mist.at(plan.camera.distance(plan.camera_k, p) / plan.world.frame.scale)[None]
