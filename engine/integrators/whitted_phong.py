"""Whitted's ray tracing with the illumination model of the lecture: k_a, k_d, k_s and n, added up over all lights.

    I = sum over lights of  k_a I_L + s (k_d I_L max(n . l, 0) + k_s I_L max(r_l . v, 0)^n)            (Phong 1975)

s is the shadow ray's share. I_L is the irradiance of a surface that faces the light [W m^-2], or without
`light_falloff` that of the light at a distance of one metre. There is no 1 / pi and no normalisation: k_d I_L, in
units of I_L, is what is seen, so a dull surface is pi times as bright as in nature. k_d is the reflectance of Lambert
lobes, k_s and n those of Phong lobes, k_a the `ambient` of materials.
"""

from ..wavefront.branching import mirrored_and_refracted
from ..wavefront.hard_light import add_illumination, to_middles
from . import registry


@registry.add
class WhittedPhong:
    """Whitted with the illumination model of 1975, k_a + k_d (n.l) + k_s (r.v)^n, as lectures teach it; not physical."""

    key = "whitted_phong"
    label = "Whitted (Phong Illumination)"
    is_complete = False
    samples_lights = True
    splits_white = True
    splits_specular = True
    tints_glass = True
    on_surface = (add_illumination,)
    to_lights = staticmethod(to_middles)

    @staticmethod
    def scatter(plan, rays, surface, reflection):
        return mirrored_and_refracted(plan, rays, surface, reflection)
