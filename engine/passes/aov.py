"""What materials say of their surfaces beside how they look ("arbitrary output variables")."""

import re
from dataclasses import dataclass

import numpy as np

from ..wavefront.recording import FirstHit
from ..wavefront.texturing import points_of
from . import registry


@registry.add_family
@dataclass(frozen=True)
class Aov(FirstHit):
    """What `Material.aovs` have under a name, where camera rays hit, averaged; 0, and not there, where materials have none.

    kind  "Color": red, green, blue, and the share of the pixel that has any; "Value": a number
    """

    pattern = "AOV Color <name>, AOV Value <name>"

    kind: str
    name: str

    @classmethod
    def of(cls, key):
        """The pass of that name, or None."""
        found = re.fullmatch("AOV (Color|Value) (.+)", key)
        return found and cls(found[1], found[2])

    @property
    def key(self):
        """Its name."""
        return f"AOV {self.kind} {self.name}"

    label = key

    @property
    def channels(self):
        """See `interfaces.Pass`."""
        return "RGBA" if self.kind == "Color" else "X"

    def values(self, plan, rays, surface, reflection):
        """See `interfaces.Pass`."""
        result, points = np.zeros((len(self.channels), surface.prim.size), np.float32), None
        for row, value in plan.world.materials.aovs.get(self.name, {}).items():
            lanes = np.nonzero(surface.material == row)[0]
            if not lanes.size:
                continue
            points = points or points_of(plan, rays, surface)
            found = points.take(lanes).on(surface.take(lanes)).value(value)
            result[:3, lanes] = found if self.kind == "Color" else found.mean(axis=0)
            result[3:, lanes] = 1
        # What is no number is none.
        return np.nan_to_num(result, nan=0, posinf=0, neginf=0)
