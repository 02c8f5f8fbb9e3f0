"""What kind of ray looks at a point."""

from dataclasses import dataclass

from ..errors import SceneError
from . import registry

_KINDS = ("camera", "shadow", "diffuse", "glossy", "singular", "reflection", "transmission")
_COUNTS = ("length", "depth", "diffuse depth", "glossy depth", "transmission depth", "transparent depth")


@registry.add
@dataclass(frozen=True, eq=False)
class LightPath:
    """1 or 0 for the kind of ray, its length [m], or how often its path was scattered before.

    output  "camera", straight from the camera; "shadow", from a surface to a light; "diffuse", "glossy", "singular", scattered last
            by a lobe of that kind (a singular one is glossy as well); "reflection", "transmission", to which side; "length";
            "depth", "diffuse depth", "glossy depth", "transmission depth", "transparent depth"
    Where a light is sampled that glows itself, none of the kinds is 1.
    """

    key = "light path"
    label = "Light Path"
    is_pure = False

    output: str = "camera"

    def check(self, owner):
        if self.output not in (*_KINDS, *_COUNTS):
            raise SceneError(f"{owner}: output of its light path is '{self.output}', allowed: {', '.join((*_KINDS, *_COUNTS))}")

    @property
    def asks_for_past(self):
        """Whether paths must carry along what has scattered them."""
        return self.output not in ("camera", "shadow", "length", "depth")

    @property
    def counts_bounces(self):
        """Whether it differs from bounce to bounce."""
        return self.output.endswith("depth")

    def eval(self, at):
        return at.path(self.output)
