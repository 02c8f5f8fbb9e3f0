"""Colours of rough glass."""

from dataclasses import dataclass

import numpy as np

from ..maths.ggx import boundary
from ..maths.vectors import dot
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class GlassTint:
    """What is left of light that a rough boundary sends on, either way, if the facets that it meets again tint it, as Blender has it.

    Of what meets GGX's facets once the share B is sent on, see `maths.ggx`; the rest meets them again, and of that a tint t leaves
    F = t B_mean / (1 - t (1 - B_mean)) (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks"): together
    B + (1 - B) F. All of it for t = 1.

    tint       of what passes once
    roughness  Blender's, 0 to 1
    eta        relative index of refraction, see `RelativeIndex`
    preserves  whether what meets the facets again is sent on at all
    """

    key = "glass tint"
    label = "Glass Tint"
    is_pure = False
    asks_for_cosine = True

    tint: object = (1.0, 1.0, 1.0)
    roughness: object = 0.5
    eta: object = 1.5
    preserves: bool = True

    def check(self, owner):
        pass

    def eval(self, at):
        cos = np.abs(dot(at.d, at.surface.ns))
        roughness, eta = (np.nan_to_num(at.value(x)[0]) for x in (self.roughness, self.eta))
        once, mean = boundary(cos, np.clip(roughness, 0, 1), np.clip(eta, 1e-3, 1e3))
        if not self.preserves:
            return once[None]
        tint = np.clip(np.nan_to_num(at.value(self.tint)), 0, 1)
        again = tint * mean / np.maximum(1 - tint * (1 - mean), np.finfo(np.float32).tiny)
        return once + (1 - once) * again
