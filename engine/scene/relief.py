"""Shading normals bent by textures: what a material wears over the shape of its mesh."""

import math
from dataclasses import dataclass

from ..errors import SceneError


@dataclass(frozen=True)
class NormalMap:
    """Normals from the colours of `texture`, 2 c - 1, in the tangent frame of a uv layer: u, v, and the surface's normal.

    strength  scales what leads away from the surface's normal, >= 0
    layer     the uv layer; empty: the mesh's first
    """

    texture: object = 0.5
    strength: float = 1.0
    layer: str = ""

    def check(self, owner):
        """Raises SceneError, naming the material `owner`, for a strength out of range."""
        if not 0 <= self.strength < math.inf:
            raise SceneError(f"material '{owner}': strength of its normal map is {self.strength}, allowed: finite, from 0 on")


@dataclass(frozen=True)
class BumpMap:
    """Normals of the surface as if it were raised by `distance` [m] times the luminance of `texture`; negative digs in.

    strength  0 is the surface's normal, 1 the bent one
    """

    texture: object = 0.5
    distance: float = 0.1
    strength: float = 1.0

    def check(self, owner):
        """Raises SceneError, naming the material `owner`, for numbers out of range."""
        if not (math.isfinite(self.distance) and 0 <= self.strength < math.inf):
            raise SceneError(f"material '{owner}': bump has distance {self.distance} and strength {self.strength}, allowed: finite")


RELIEFS = {"NormalMap": NormalMap, "BumpMap": BumpMap}
