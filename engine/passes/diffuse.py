"""Light that diffuse lobes of the first surface have sent to the camera, and what share of light those send on."""

from ..wavefront.splitting import DIFFUSE, colour, part
from . import registry


@registry.add
class DiffuseColor:
    """The share of light that diffuse lobes send on, where camera rays hit; averaged over the pixel."""

    key = "Diffuse Color"
    label = "Diffuse Color"
    channels = "RGB"
    records = "first hit"
    background = 0.0
    reduction = "mean"
    divided_by = ""

    @staticmethod
    def values(plan, rays, surface, reflection):
        return colour(reflection, surface, DIFFUSE)


@registry.add
class DiffuseDirect:
    """Light that diffuse lobes send from lights straight to the camera, before it is multiplied by their colour [W m^-2 sr^-1]."""

    key = "Diffuse Direct"
    label = "Diffuse Direct"
    channels = "RGB"
    records = "light"
    background = 0.0
    is_split = True
    reduction = "mean"
    divided_by = "Diffuse Color"

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return part(rays, lanes, L, DIFFUSE) if bounces == 1 else 0


@registry.add
class DiffuseIndirect:
    """Light that diffuse lobes send to the camera after other surfaces, before it is multiplied by their colour [W m^-2 sr^-1]."""

    key = "Diffuse Indirect"
    label = "Diffuse Indirect"
    channels = "RGB"
    records = "light"
    background = 0.0
    is_split = True
    reduction = "mean"
    divided_by = "Diffuse Color"

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return part(rays, lanes, L, DIFFUSE) if bounces > 1 else 0
