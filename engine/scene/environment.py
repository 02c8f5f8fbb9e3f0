"""A picture of everything far away."""

from dataclasses import dataclass, field

import numpy as np

from ..arrays import frozen
from ..errors import SceneError
from ..memory import require

INTERPOLATIONS = ("linear", "closest")
_BYTES = 60
"""Of a pixel, while a world is made of it; measured, rounded up."""


@dataclass(frozen=True, kw_only=True, eq=False)
class EnvironmentMap:
    """Radiance from every direction as an equirectangular picture, oriented as Blender's.

    pixels          (3, H, W) float32 [W m^-2 sr^-1], linear Rec. 709; row 0 is about +z, the bottom row about -z; the
                    middle column looks along +x, one quarter to the left of it +y
    world_from_map  (3, 3) orthogonal: turns, or mirrors, the picture's frame into the world's
    strength        factor of the radiance, (r, g, b)
    interpolation   between the middles of pixels "linear", or "closest"
    Raises SceneError where shapes do not fit, MemoryShortage where the picture would not.
    """

    pixels: np.ndarray
    name: str = "Environment"
    world_from_map: np.ndarray = field(default_factory=lambda: np.eye(3))
    strength: tuple = (1.0, 1.0, 1.0)
    interpolation: str = "linear"

    def __post_init__(self):
        subject = f"environment '{self.name}'"
        if np.ndim(self.pixels) == 3:
            height, width = np.shape(self.pixels)[1:]
            what = f"the pixels of {subject}, {width}x{height} of them, and the tables by which they are found,"
            require(height * width * _BYTES, what, "scale it down")
        try:
            pixels = frozen(self.pixels, np.float32, (3, None, None), subject, "pixels")
            matrix = frozen(self.world_from_map, np.float64, (3, 3), subject, "world_from_map")
        except ValueError as error:
            raise SceneError(str(error)) from None
        if not pixels.size:
            raise SceneError(f"{subject}: its picture of {pixels.shape[2]} x {pixels.shape[1]} pixels is empty")
        if self.interpolation not in INTERPOLATIONS:
            raise SceneError(f"{subject}: interpolation is {self.interpolation!r}, allowed: {', '.join(INTERPOLATIONS)}")
        object.__setattr__(self, "pixels", pixels)
        object.__setattr__(self, "world_from_map", matrix)
        object.__setattr__(self, "strength", tuple(float(c) for c in self.strength))

    @property
    def gives_light(self):
        """Whether any direction is not black."""
        return bool((self.pixels.max(axis=(1, 2)) * np.array(self.strength) > 0).any())
