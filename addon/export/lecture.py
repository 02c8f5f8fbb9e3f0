"""The lecture's parameters of a material, `material.glanz`, as the engine's lobes and medium."""

import numpy as np

from ...engine import BlinnPhong, Dielectric, Lambert, Medium, Mirror, Phong, PhongLecture, PhongTransmission
from .closure import Closure
from .inside import DENSEST, with_dispersion

_NORMALISATIONS = {bsdf.key: bsdf for bsdf in (Phong, PhongLecture, BlinnPhong)}


def is_lecture(material):
    """Whether a material (or None) goes by the lecture's parameters instead of its nodes."""
    return material is not None and material.glanz.use_lecture


def lecture_surface(material, owner, findings):
    """The `Closure` of k_d, k_s, n, k_r, k_t and what goes with k_t; notes coefficients that ask for too much light."""
    k = material.glanz
    glossy = _NORMALISATIONS[k.normalisation](tuple(k.k_s), k.exponent)
    lobes = [Lambert(tuple(k.k_d)), glossy]
    if any(k.k_t) and k.is_sheet:
        lobes += [Mirror(tuple(k.k_r)), PhongTransmission(tuple(k.k_t), k.sheet_exponent)]
    elif any(k.k_t):
        # The lecture's constants, in place of Fresnel's equations.
        lobes += with_dispersion((Dielectric(k.ior, tuple(k.k_r), tuple(k.k_t), is_fresnel=False),), material)
    else:
        lobes.append(Mirror(tuple(k.k_r)))
    total = Closure(tuple(lobes)).albedo().max()
    if total > 1 + 1e-6:
        share = "k_s (n + 2) / (n + 1)" if isinstance(glossy, PhongLecture) else "k_s"
        findings.note(f"k_d + {share} + k_r + k_t is {total:.4g}, more than 1", owner)
    return Closure(tuple(lobes))


def lecture_medium(material):
    """The `Medium` behind the surface, or None where it is nothing but clear: of a way as long as the distance the colour is left."""
    k = material.glanz
    with np.errstate(divide="ignore", invalid="ignore"):
        absorption = -np.log(np.array(k.absorption_colour, np.float64)) / k.absorption_distance
    # Not min(): what is not a number is for the engine to refuse.
    absorption = np.where(absorption > DENSEST, DENSEST, absorption) + 0.0
    is_clear = k.is_sheet or not any(k.k_t) or not (absorption.any() or k.priority)
    return None if is_clear else Medium(absorption=tuple(absorption.tolist()), priority=k.priority)
