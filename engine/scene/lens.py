"""The opening of a camera, through which it sees sharply at one distance only."""

import math
from dataclasses import dataclass

from ..errors import SceneError


@dataclass(frozen=True, kw_only=True)
class Lens:
    """A thin lens (Cook, Porter and Carpenter 1984): all rays of a film position meet where the scene is in focus.

    radius          of the aperture [m]; 0 is a pinhole, which sees everything sharply
    focus_distance  where points are sharp [m]: along the camera's axis, for a panorama along the ray
    blades          corners of the aperture, which is then a regular polygon with `radius` to its corners; 0: a disk
    rotation        of the polygon, counter-clockwise [rad]; at 0 the middle of an edge is on the right
    ratio           height of the aperture over its width; `radius` is half the height
    """

    radius: float = 0.0
    focus_distance: float = 10.0
    blades: int = 0
    rotation: float = 0.0
    ratio: float = 1.0

    @property
    def is_open(self):
        """Whether it differs from a pinhole."""
        return self.radius > 0

    def check(self, owner):
        """Raises SceneError, naming the camera `owner`, for values out of range."""
        is_polygon = self.blades >= 3 and self.blades % 1 == 0
        for name, value, is_right, allowed in (
            ("aperture radius", self.radius, 0 <= self.radius < math.inf, "finite, from 0 on"),
            ("focus distance", self.focus_distance, self.focus_distance > 0, "above 0"),
            ("number of aperture blades", self.blades, self.blades == 0 or is_polygon, "0 for a disk, or whole from 3 on"),
            ("aperture rotation", self.rotation, math.isfinite(self.rotation), "finite"),
            ("aperture ratio", self.ratio, 0 < self.ratio < math.inf, "finite, above 0"),
        ):
            if not is_right:
                raise SceneError(f"camera '{owner}': {name} is {value}, allowed: {allowed}")

    def row(self, scale):
        """The parameters in render space, of `scale` [m^-1], as {column: number}."""
        return {
            "lens_width": self.radius / self.ratio * scale,
            "lens_height": self.radius * scale,
            "blades": max(self.blades, 3),
            "rotation": self.rotation,
            "per_focus": 1 / (self.focus_distance * scale),
        }


PINHOLE = Lens()
