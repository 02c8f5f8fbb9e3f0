"""What denoisers want to know of a picture beside its colours (Open Image Denoise, *Auxiliary features*)."""

import numpy as np

from ..wavefront.recording import FirstHit
from ..wavefront.splitting import KINDS, colour
from . import registry


@registry.add
class DenoisingAlbedo(FirstHit):
    """The share of light that all lobes together send on, where camera rays hit, and what shines straight into the camera; averaged."""

    key = "Denoising Albedo"
    label = "Denoising Albedo"
    channels = "RGB"
    records = "first hit and light"

    @staticmethod
    def values(plan, rays, surface, reflection):
        return sum(colour(reflection, surface, kind) for kind in KINDS.values())

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return L if bounces == 0 else 0


@registry.add
class DenoisingNormal(FirstHit):
    """The shading normal in the frame of the camera, which looks along +z, on the viewer's side, averaged; 0 where nothing is met."""

    key = "Denoising Normal"
    label = "Denoising Normal"
    channels = "XYZ"

    @staticmethod
    def values(plan, rays, surface, reflection):
        return plan.world.camera.vectors(surface.ns) * np.float32(plan.world.frame.scale)


@registry.add
class DenoisingDepth(FirstHit):
    """How far camera rays have come [m], averaged; 0 where nothing is met."""

    key = "Denoising Depth"
    label = "Denoising Depth"
    channels = "Z"

    @staticmethod
    def values(plan, rays, surface, reflection):
        return surface.t[None] / np.float32(plan.world.frame.scale)
