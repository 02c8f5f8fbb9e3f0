"""Light that glossy lobes of the first surface have sent to the camera, and what share of light those send on."""

from ..wavefront.splitting import GLOSSY, colour, part
from . import registry


@registry.add
class GlossyColor:
    """The share of light that glossy lobes send on, where camera rays hit; averaged over the pixel."""

    key = "Glossy Color"
    label = "Glossy Color"
    channels = "RGB"
    records = "first hit"
    background = 0.0
    reduction = "mean"
    divided_by = ""

    @staticmethod
    def values(plan, rays, surface, reflection):
        return colour(reflection, surface, GLOSSY)


@registry.add
class GlossyDirect:
    """Light that glossy lobes send from lights straight to the camera, before it is multiplied by their colour [W m^-2 sr^-1]."""

    key = "Glossy Direct"
    label = "Glossy Direct"
    channels = "RGB"
    records = "light"
    background = 0.0
    is_split = True
    reduction = "mean"
    divided_by = "Glossy Color"

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return part(rays, lanes, L, GLOSSY) if bounces == 1 else 0


@registry.add
class GlossyIndirect:
    """Light that glossy lobes send to the camera after other surfaces, before it is multiplied by their colour [W m^-2 sr^-1]."""

    key = "Glossy Indirect"
    label = "Glossy Indirect"
    channels = "RGB"
    records = "light"
    background = 0.0
    is_split = True
    reduction = "mean"
    divided_by = "Glossy Color"

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return part(rays, lanes, L, GLOSSY) if bounces > 1 else 0
