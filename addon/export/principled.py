"""The Principled BSDF as a diffuse, a glossy and a clear lobe: pure functions of its numbers.

Blender's model is a metal (share m, colour c) beside what is no metal: glass (share t), or a dielectric coat over a
diffuse base of the same colour. The engine's Phong and Lambert lobes have reflectances that do not depend on the angle,
so the coat reflects its average over a cosine-weighted hemisphere F, and the base receives the rest:

    glossy   m c + (1 - m) (1 - t) F tint
    diffuse  (1 - m) (1 - t) (1 - F) c         (F: its largest channel, so that nothing is reflected twice)
    clear    (1 - m) t, exact Fresnel; what passes is tinted by sqrt(c), as light passes twice

Their sum is at most 1 for c and tint in [0, 1]: m c + (1 - m) (F + (1 - F) c) <= 1 where t = 0. What is lost against
Blender is the brighter rim at grazing angles; what is kept is the light that leaves the surface under even light.
"""

from functools import lru_cache

import numpy as np

from ...engine import Dielectric, Lambert
from .closure import glossy_lobes
from .colours import added, as_texture, cut, times, typical, varies

_ANGLES = 2048


def principled_lobes(base, metallic, roughness, ior, specular_level, tint=(1.0, 1.0, 1.0), transmission=0.0):
    """The lobes of a Principled BSDF, diffuse, glossy and, where it transmits, clear; all but `ior` in [0, 1].

    The base colour may be a texture; what passes is tinted by its average.
    """
    base = as_texture(base) if varies(base) else cut(base)
    m = min(max(metallic, 0.0), 1.0)
    coat = average_fresnel(effective_ior(ior, specular_level)) * np.clip(np.array(tint, np.float64), 0, 1)
    t = min(max(transmission, 0.0), 1.0)
    lambert = times(base, (1 - m) * (1 - t) * (1 - coat.max())) if m * t < 1 else (0.0, 0.0, 0.0)
    coat = (1 - m) * (1 - t) * coat
    glossy = added(times(base, m), coat) if m > 0 else tuple(coat.tolist())
    clear = (1 - m) * t
    lobes = (Lambert(lambert), *glossy_lobes(glossy, roughness))
    return (*lobes, Dielectric(ior, (clear,) * 3, times(np.sqrt(typical(base)), clear))) if clear > 0 else lobes


def effective_ior(ior, specular_level):
    """The index of refraction whose reflection at normal incidence is 2 * specular_level times that of `ior` (Blender 4.0 on)."""
    f0 = ((ior - 1) / (ior + 1)) ** 2 * 2 * max(specular_level, 0.0)
    root = min(f0, 0.99) ** 0.5
    return (1 + root) / (1 - root)


@lru_cache(maxsize=256)
def average_fresnel(ior):
    """Share of cosine-weighted light that a smooth dielectric with `ior` >= 1 reflects: integral of F(cos) 2 cos dcos."""
    cos = (np.arange(_ANGLES) + 0.5) / _ANGLES
    cos_t = np.sqrt(1 - (1 - cos * cos) / (ior * ior))
    across = (cos - ior * cos_t) / (cos + ior * cos_t)
    along = (ior * cos - cos_t) / (ior * cos + cos_t)
    return float(np.mean((across * across + along * along) * cos))
