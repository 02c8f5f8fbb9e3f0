"""The light of a group of lights, to be made brighter or darker when the picture is there."""

from dataclasses import dataclass

from ..wavefront.recording import OfLight
from . import registry

_PREFIX = "Combined_"


@registry.add_family
@dataclass(frozen=True)
class LightGroup(OfLight):
    """What lights, glowing objects and a world whose `group` is `name` send to the camera, by whatever way [W m^-2 sr^-1]."""

    pattern = f"{_PREFIX}<light group>"
    channels = "RGB"

    name: str

    @classmethod
    def of(cls, key):
        """The pass of that name, or None."""
        name = key.removeprefix(_PREFIX)
        return cls(name) if name and name != key else None

    @property
    def key(self):
        """Its name."""
        return _PREFIX + self.name

    label = key

    def part(self, plan, rays, lanes, L, light, bounces):
        """See `interfaces.Pass`."""
        is_member = plan.world.light_groups.get(self.name)
        return 0 if is_member is None else L * is_member[0 if light is None else light]
