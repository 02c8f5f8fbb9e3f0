"""Surfaces as if they were raised."""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.facing import across, raised
from ..maths.vectors import as_vector
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class BumpMap:
    """The normal of the surface as if it were raised by `distance` [m] times the height `texture`; negative digs in.

    strength  0 is the surface's normal, 1 the bent one, from 0 on
    normal    what is bent, unit, world space; None: the shading normal
    is_dug    digs in instead
    width     how far apart heights are compared, in pixels as they are at the point
    """

    key = "bump map"
    label = "Bump"
    is_pure = False
    asks_for_width = True

    texture: object = 0.0
    distance: object = 0.1
    strength: object = 1.0
    normal: object = None
    is_dug: bool = False
    width: float = 0.1

    def check(self, owner):
        if not 0 < self.width < math.inf:
            raise SceneError(f"{owner}: width of its bump is {self.width}, allowed: finite, above 0")

    def eval(self, at):
        ns = at.surface.ns if self.normal is None else as_vector(at.value(self.normal))
        right, up = across(at.surface.n)
        step = np.float32(self.width) * at.pixel_width
        per_step = at.value(self.distance)[0] * np.float32(-at.frame.scale if self.is_dug else at.frame.scale) / step
        height = _height(self, at)
        slopes = [per_step * (_height(self, at.away(*way)) - height) for way in ((self.width, 0.0), (0.0, self.width))]
        return raised(ns, right, up, slopes, np.maximum(at.value(self.strength)[0], 0))


def _height(bump, at):
    value = at.value(bump.texture)
    return value[0] if len(value) == 1 else value.mean(axis=0)
