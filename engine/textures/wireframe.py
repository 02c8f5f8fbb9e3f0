"""The edges of triangles."""

from dataclasses import dataclass

import numpy as np

from ..maths.vectors import cross, dot
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Wireframe:
    """1 within half of `size` from an edge of the triangle, else 0.

    size       [m], or where it `is_pixels` as many pixels at the depth of the point
    """

    key = "wireframe"
    label = "Wireframe"
    is_pure = False

    size: object = 0.01
    is_pixels: bool = False

    @property
    def asks_for_width(self):
        """Whether it matters how wide rays are."""
        return self.is_pixels

    def check(self, owner):
        pass

    def eval(self, at):
        e1, e2 = at.edges
        half = np.float32(0.5) * at.value(self.size)[0] * (at.pixel_width if self.is_pixels else np.float32(at.frame.scale))
        to_p = at.u * e1 + at.v * e2
        is_near = np.zeros(at.u.shape, bool)
        for edge, start in ((e1, 0), (e2, 0), (e2 - e1, e1)):
            area = cross(edge, to_p - start)
            is_near |= dot(area, area) < dot(edge, edge) * (half * half)
        return is_near[None].astype(np.float32)
