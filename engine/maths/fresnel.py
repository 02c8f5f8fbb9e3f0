"""Reflection and refraction at a smooth boundary; eta is the index behind the surface over that in front of it."""

import numpy as np

from ..errors import SceneError
from .vectors import dot


def refracted_cosine(cos_i, eta):
    """The cosine (N,) of the refracted direction by Snell's law; 0 where light is totally reflected.

    cos_t^2 = (eta^2 - 1 + cos_i^2) / eta^2, with eta^2 - 1 as a product: no digits are lost near the critical angle or
    for eta near 1.
    """
    return np.sqrt(np.maximum((eta - 1) * (eta + 1) + cos_i * cos_i, 0)) / eta


def fresnel_dielectric(cos_i, eta):
    """The share (N,) of unpolarised light that a smooth dielectric reflects (Fresnel; Born & Wolf, 1.5.2, eq. 21).

    cos_i (N,) in [0, 1]; exactly 1 where light is totally reflected.
    """
    cos_t = refracted_cosine(cos_i, eta)
    with np.errstate(invalid="ignore"):
        parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t)
        across = (cos_i - eta * cos_t) / (cos_i + eta * cos_t)
    share = 0.5 * (parallel * parallel + across * across)
    # Also 0 / 0, along the surface.
    return np.where(cos_t > 0, share, 1)


def check_etendue(owner, etendue):
    """Raises SceneError, naming the material `owner`, where radiance cannot be scaled by `etendue`."""
    if not 0 < etendue < float("inf"):
        raise SceneError(f"material '{owner}': etendue is {etendue}, allowed: a finite number above 0")


def index_of_level(ior, level):
    """The index (N,) that reflects 2 * `level` times what `ior` does at normal incidence, at most 0.99: Blender's Specular IOR Level."""
    amplitude = np.sqrt(np.minimum(np.square((ior - 1) / (ior + 1)) * (2 * np.maximum(level, 0)), np.float32(0.99)))
    return (1 + amplitude) / (1 - amplitude)


def fresnel_conductor(cos_i, eta, k):
    """The share (3, N) of unpolarised light that a smooth conductor of the index eta + i k (3, N) reflects at cos_i (N,).

    Born & Wolf, 14.2: with a^2 + b^2 = |eta_c^2 - sin^2| and a = Re sqrt(eta_c^2 - sin^2), eta_c the complex index,

        R_across   = (a^2 + b^2 - 2 a cos + cos^2) / (a^2 + b^2 + 2 a cos + cos^2)
        R_parallel = R_across ((a^2 + b^2) cos^2 - 2 a cos sin^2 + sin^4) / ((a^2 + b^2) cos^2 + 2 a cos sin^2 + sin^4)
    """
    cos2 = cos_i * cos_i
    sin2 = 1 - cos2
    real, half = eta * eta - k * k - sin2, eta * k
    whole = np.sqrt(real * real + 4 * half * half)
    a = np.sqrt(np.maximum(0.5 * (whole + real), 0))
    step = 2 * a * cos_i
    across = (whole - step + cos2) / (whole + step + cos2)
    parallel = across * (whole * cos2 - step * sin2 + sin2 * sin2) / (whole * cos2 + step * sin2 + sin2 * sin2)
    return 0.5 * (across + parallel)


def refract(wo, n, eta):
    """The refracted direction (3, N) of wo about n, wo on the side of n; meaningless where `refracted_cosine` is 0.

    The lecture's t = -wo / eta + (cos_i / eta - cos_t) n.
    """
    cos_i = dot(wo, n)
    wi = (cos_i / eta - refracted_cosine(cos_i, eta)) * n - wo / eta
    return wi / np.sqrt(dot(wi, wi))
