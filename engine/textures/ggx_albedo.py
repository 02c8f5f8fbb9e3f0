"""How much a rough surface reflects towards the viewer."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.fresnel import fresnel_conductor, index_of_level
from ..maths.ggx import fresnel_moment, mean_albedo, moment
from ..maths.vectors import as_vector, dot
from . import registry

_KINDS = ("dielectric", "mirror", "metal", "conductor", "boundary")
_RIM = 1 / 7
"""The cosine at which F82 has its tint (Kutz, Hasan and Edmondson 2021, "Novel aspects of the Adobe Standard Material")."""


_MOST_LEVEL = 1e6
"""Specular levels beyond are the same; what is infinite would be no number where the index is 1."""


@registry.add
@dataclass(frozen=True, eq=False)
class GgxAlbedo:
    """The directional albedo of GGX's microfacets, (3, N), in [0, 1].

    roughness  Blender's, 0 to 1
    kind       "dielectric": a coat of index `ior` at Blender's specular `level`, whose reflection goes from its own times `tint` to 1;
               "mirror": one that reflects the colour `f0` at all angles;
               "metal": Schlick's Fresnel from the colour `f0`, with the colour `tint` at 82 degrees (F82);
               "conductor": the same, with what the complex index `ior` + i `extinction` has there by Fresnel's equations;
               "boundary": of all light at a boundary between `eta` = `ior` and 1, the share that does not pass
    preserves  light that is reflected more than once is reflected, too (as fitted by Turquin 2019, "Practical multiple scattering
               compensation for microfacet models"), else lost
    is_rest    instead what is left for layers below: 1 - its largest channel
    """

    key = "ggx albedo"
    label = "GGX Albedo"
    is_pure = False
    asks_for_cosine = True

    roughness: object = 0.5
    ior: object = 1.5
    f0: object = (1.0, 1.0, 1.0)
    tint: object = (1.0, 1.0, 1.0)
    level: object = 0.5
    extinction: object = 0.0
    kind: str = "metal"
    preserves: bool = True
    is_rest: bool = False

    def check(self, owner):
        if self.kind not in _KINDS:
            raise SceneError(f"{owner}: kind of its GGX albedo is '{self.kind}', allowed: {', '.join(_KINDS)}")

    def eval(self, at):
        albedo = np.clip(at.once((id(self), "albedo"), lambda: self._albedo(at)), 0, 1)
        return 1 - albedo.max(axis=0, keepdims=True) if self.is_rest else albedo

    def _albedo(self, at):
        cos, roughness = np.abs(dot(at.d, at.surface.ns)), np.clip(np.nan_to_num(at.value(self.roughness)[0]), 0, 1)
        if self.kind == "boundary":
            return fresnel_moment("V", cos, roughness, np.clip(np.nan_to_num(at.value(self.ior)[0]), 1e-3, 1e3))[None]
        whole = moment("A", cos, roughness)
        if self.kind == "mirror":
            mean = np.clip(np.nan_to_num(at.value(self.f0)), 0, 1)
            single = mean * whole
        elif self.kind in ("metal", "conductor"):
            f0, missing = self._metal(at)
            b = missing / (_RIM * (1 - _RIM) ** 6)
            single = f0 * whole + (1 - f0) * moment("P", cos, roughness) - b * moment("Q", cos, roughness)
            mean = f0 + (1 - f0) / 21 - b / 126
        else:
            level = np.clip(np.nan_to_num(at.value(self.level)[0]), 0, _MOST_LEVEL)
            ior = index_of_level(np.clip(np.nan_to_num(at.value(self.ior)[0]), 1e-3, 1e3), level)
            own = np.square((ior - 1) / (ior + 1))
            f0 = np.clip(own * np.nan_to_num(at.value(self.tint)), 0, 1)
            # Its Fresnel, stretched to go from f0 to 1.
            rise = (fresnel_moment("F", cos, roughness, ior) - own * whole) / np.maximum(1 - own, np.finfo(np.float32).tiny)
            single = f0 * whole + (1 - f0) * rise
            mean = f0 + (1 - f0) / 21
        single = np.maximum(single, 0)
        if not self.preserves:
            return single
        held = mean_albedo(roughness)
        again = mean * held / (1 - mean * (1 - held))
        return single * (1 + again * (1 - whole) / np.maximum(whole, np.finfo(np.float32).tiny))

    def _metal(self, at):
        """What a metal reflects seen from above, and how much less at 82 degrees than Schlick's Fresnel has it, (3, N) or (3, 1)."""
        if self.kind == "conductor":
            index = [np.clip(np.nan_to_num(as_vector(at.value(x))), least, 1e3) for x, least in ((self.ior, 1e-3), (self.extinction, 0))]
            f0, rim = (fresnel_conductor(np.float32(cos), *index) for cos in (1, _RIM))
            return f0, _at_rim(f0) - rim
        f0, tint = (np.clip(np.nan_to_num(at.value(x)), 0, 1) for x in (self.f0, self.tint))
        return f0, _at_rim(f0) * (1 - tint)


def _at_rim(f0):
    """What Schlick's Fresnel has at 82 degrees for `f0`."""
    return f0 + (1 - f0) * (1 - _RIM) ** 5
