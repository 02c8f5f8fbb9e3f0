"""Light that lobes that transmit of the first surface have sent to the camera, and what share of light those send on."""

from ..wavefront.splitting import TRANSMITTED, colour, part
from . import registry


@registry.add
class TransmissionColor:
    """The share of light that lobes that transmit send on, where camera rays hit; averaged over the pixel."""

    key = "Transmission Color"
    label = "Transmission Color"
    channels = "RGB"
    records = "first hit"
    background = 0.0
    reduction = "mean"
    divided_by = ""

    @staticmethod
    def values(plan, rays, surface, reflection):
        return colour(reflection, surface, TRANSMITTED)


@registry.add
class TransmissionDirect:
    """Light that lobes that transmit send from lights straight to the camera, before it is multiplied by their colour [W m^-2 sr^-1]."""

    key = "Transmission Direct"
    label = "Transmission Direct"
    channels = "RGB"
    records = "light"
    background = 0.0
    is_split = True
    reduction = "mean"
    divided_by = "Transmission Color"

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return part(rays, lanes, L, TRANSMITTED) if bounces == 1 else 0


@registry.add
class TransmissionIndirect:
    """Light that lobes that transmit send to the camera after other surfaces, before it is multiplied by their colour [W m^-2 sr^-1]."""

    key = "Transmission Indirect"
    label = "Transmission Indirect"
    channels = "RGB"
    records = "light"
    background = 0.0
    is_split = True
    reduction = "mean"
    divided_by = "Transmission Color"

    @staticmethod
    def part(plan, rays, lanes, L, light, bounces):
        return part(rays, lanes, L, TRANSMITTED) if bounces > 1 else 0
