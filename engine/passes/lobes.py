"""Light by the kinds of lobes of the first surface that have sent it to the camera, and what share of light these send on."""

from dataclasses import dataclass

from ..wavefront.recording import FirstHit, OfLight
from ..wavefront.splitting import KINDS, colour, part
from . import registry


@dataclass(frozen=True)
class LobeColour(FirstHit):
    """The share of light that lobes of one kind send on, where camera rays hit; averaged over the pixel."""

    channels = "RGB"

    kind: str

    @property
    def key(self):
        """Its name."""
        return f"{self.kind} Color"

    label = key

    def values(self, plan, rays, surface, reflection):
        """See `interfaces.Pass`."""
        return colour(reflection, surface, KINDS[self.kind])


@dataclass(frozen=True)
class LobeLight(OfLight):
    """Light that lobes of one kind send to the camera, before it is multiplied by their colour [W m^-2 sr^-1].

    way  "Direct": straight from lights; "Indirect": after other surfaces
    """

    channels = "RGB"
    is_split = True

    kind: str
    way: str

    @property
    def key(self):
        """Its name."""
        return f"{self.kind} {self.way}"

    label = key

    @property
    def divided_by(self):
        """See `interfaces.Pass`."""
        return LobeColour(self.kind).key

    def part(self, plan, rays, lanes, L, light, bounces):
        """See `interfaces.Pass`."""
        is_asked = bounces == 1 if self.way == "Direct" else bounces > 1
        return part(rays, lanes, L, KINDS[self.kind]) if is_asked else 0


for kind in KINDS:
    registry.add(LobeColour(kind))
    for way in ("Direct", "Indirect"):
        registry.add(LobeLight(kind, way))
