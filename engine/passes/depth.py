"""How far away things are."""

from ..wavefront.recording import FirstHit
from . import registry


@registry.add
class Depth(FirstHit):
    """How far away the first sample meets something [m], along the camera's axis; in a panorama along the ray. Else 1e10, as Cycles'."""

    key = "Depth"
    label = "Depth"
    channels = "Z"
    reduction = "first"
    background = 1e10

    @staticmethod
    def values(plan, rays, surface, reflection):
        p = plan.seen_from_camera(plan, rays, surface.p)
        return plan.camera.depth(plan.camera_k, p)[None] / plan.world.frame.scale
