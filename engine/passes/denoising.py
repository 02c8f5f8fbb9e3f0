"""What denoisers want to know of a picture beside its colours (Open Image Denoise, *Auxiliary features*)."""

import numpy as np

from ..wavefront.splitting import DIFFUSE, GLOSSY, TRANSMITTED, colour
from . import registry


@registry.add
class DenoisingAlbedo:
    """The share of light that all lobes together send on, where camera rays hit, and what shines straight into the camera; averaged."""

    key = "Denoising Albedo"
    label = "Denoising Albedo"
    channels = "RGB"
    records = "first hit and light"
    reduction = "mean"
    divided_by = ""
    background = 0.0

    @staticmethod
    def values(plan, rays, surface, reflection):
        return sum(colour(reflection, surface, kind) for kind in (DIFFUSE, GLOSSY, TRANSMITTED))

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return L if bounces == 0 else 0


@registry.add
class DenoisingNormal:
    """The shading normal in the frame of the camera, which looks along +z, on the viewer's side, averaged; 0 where nothing is met."""

    key = "Denoising Normal"
    label = "Denoising Normal"
    channels = "XYZ"
    records = "first hit"
    reduction = "mean"
    divided_by = ""
    background = 0.0

    @staticmethod
    def values(plan, rays, surface, reflection):
        return plan.world.camera.vectors(surface.ns) * np.float32(plan.world.frame.scale)


@registry.add
class DenoisingDepth:
    """How far camera rays have come [m], averaged; 0 where nothing is met."""

    key = "Denoising Depth"
    label = "Denoising Depth"
    channels = "Z"
    records = "first hit"
    reduction = "mean"
    divided_by = ""
    background = 0.0

    @staticmethod
    def values(plan, rays, surface, reflection):
        return surface.t[None] / np.float32(plan.world.frame.scale)
