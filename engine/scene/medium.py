"""What is inside a body: the medium that light travels through behind a surface that lets it pass."""

from dataclasses import dataclass

from ..errors import SceneError


@dataclass(frozen=True, kw_only=True)
class Medium:
    """The inside of closed meshes that wear a material with it; the index of refraction is that of the material's surface.

    absorption  share of light lost per length [m^-1], (r, g, b): exp(-absorption * s) is left after s metres (Beer's law);
                inf lets nothing through
    priority    where bodies overlap, the medium of the highest priority is the one that is there
                (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images")

    Of equal priorities the body with the smaller volume is there: a bubble inside of glass needs no priority. Meshes are
    closed and do not cut through themselves. Bodies that touch count as overlapping a little; a glass of water is right
    where the water fits it, and also where it reaches into the wall and the glass has the higher priority.
    """

    absorption: tuple = (0.0, 0.0, 0.0)
    priority: int = 0

    def __post_init__(self):
        object.__setattr__(self, "absorption", tuple(float(c) for c in self.absorption))

    def check(self, owner):
        """Raises SceneError, naming the material `owner`, for values out of range."""
        if len(self.absorption) != 3 or not all(c >= 0 for c in self.absorption):
            raise SceneError(f"material '{owner}': absorption is {self.absorption}, allowed: three numbers from 0 on")
        if isinstance(self.priority, bool) or not isinstance(self.priority, int):
            raise SceneError(f"material '{owner}': priority is {self.priority!r}, allowed: whole numbers")
