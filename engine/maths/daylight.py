"""Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight", appendix A.2."""

import numpy as np

from .observer import FROM_XYZ
from .vectors import dot

_HORIZON = 0.5 * np.pi - 0.001
"""Nothing lies lower; what is below looks like it."""
_PEREZ = np.array(
    [
        [[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]],
        [[-0.0193, -0.2592], [-0.0665, 0.8 / 1000], [-0.4 / 1000, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]],
        [[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]],
    ]
)
"""The coefficients A to E of luminance Y and chromaticities x and y, each times (turbidity, 1)."""
_ZENITH = np.array(
    [
        [[0.00166, -0.00375, 0.00209, 0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]],
        [[0.00275, -0.00610, 0.00317, 0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]],
    ]
)
"""Chromaticities of the zenith: powers of the turbidity times powers of the sun's angle from it, highest first."""
_SCALE = 0.06
"""Radiance per luminance [kcd m^-2], as Blender has it."""


def preetham(d, towards, turbidity):
    """Radiance (3, N), linear Rec. 709, of the sky along d (3, N) without the sun, which is `towards` (3,)."""
    theta_sun = np.arccos(np.clip(towards[2], -1, 1))
    coefficients = _PEREZ @ (turbidity, 1.0)
    chi = (4 / 9 - turbidity / 120) * (np.pi - 2 * theta_sun)
    Y = _SCALE * ((4.0453 * turbidity - 4.9710) * np.tan(chi) - 0.2155 * turbidity + 2.4192)
    x, y = _ZENITH @ theta_sun ** np.arange(3, -1, -1.0) @ (turbidity**2, turbidity, 1.0)
    theta = np.minimum(np.arccos(np.clip(d[2], -1, 1)), np.float32(_HORIZON))
    gamma = np.arccos(np.clip(dot(d, np.array(towards, np.float32)[:, None]), -1, 1))
    zenith = (_perez(k, 0.0, theta_sun) for k in coefficients)
    scaled = (np.float32(value / base) for value, base in zip((Y, x, y), zenith))
    Y, x, y = (factor * _perez(k.astype(np.float32), theta, gamma) for factor, k in zip(scaled, coefficients))
    per_y = np.divide(Y, y, out=np.zeros_like(Y), where=y != 0)
    xyz = x * per_y, Y, (1 - x - y) * per_y
    return np.stack([np.maximum(sum(np.float32(share) * part for share, part in zip(row, xyz)), 0) for row in FROM_XYZ])


def _perez(k, theta, gamma):
    A, B, C, D, E = k
    return (1 + A * np.exp(B / np.cos(theta))) * (1 + C * np.exp(D * gamma) + E * np.cos(gamma) ** 2)
