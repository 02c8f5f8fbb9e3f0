"""Daylight scattered once by air and haze (Nishita et al. 1993, "Display of the Earth Taking into Account Atmospheric Scattering").

The atmosphere is that of Blender's Nishita sky: air and haze thin out exponentially, ozone absorbs about 25 km above the ground
(Bruneton 2017), a sun of 21 wavelengths is seen by the CIE 1931 observer. Lengths in kilometres; the sun stands in the plane of z and x.
Its constants: see LICENSES/Apache-2.0.txt.
"""

import numpy as np

from .spectrum import FROM_XYZ

EARTH, _TOP = 6360.0, 6420.0
_AIR_HEIGHT, _HAZE_HEIGHT = 8.0, 1.2
"""Over which the density falls to 1 / e."""
_HAZE = 0.02
"""Scattering [km^-1] of haze at the ground; it also absorbs 11 %."""
_ABSORBED = 1.11
_G = 0.76
_STEPS = 32
_STEP_WAVELENGTH = 20.0
_SUN = np.array(
    [
        1.4575683,
        1.56596306,
        1.65148449,
        1.71496243,
        1.75797984,
        1.78256408,
        1.79095108,
        1.7854155,
        1.76815555,
        1.7412207,
        1.70647127,
        1.66556087,
        1.61993437,
        1.57083597,
        1.51932335,
        1.46628495,
        1.41245853,
        1.35844962,
        1.30474914,
        1.25174963,
        1.19975999,
    ]
)
"""Irradiance beyond the atmosphere [W m^-2 nm^-1]."""
_AIR = np.array(
    [
        0.0542482009,
        0.0441854987,
        0.0363515191,
        0.0301792901,
        0.0252632023,
        0.0213085931,
        0.0180983803,
        0.0154705713,
        0.0133028498,
        0.0115018478,
        0.0099955743,
        0.00872799974,
        0.00765513701,
        0.00674217204,
        0.00596134126,
        0.00529034598,
        0.00471115688,
        0.00420910481,
        0.00377218381,
        0.00339051255,
        0.00305591532,
    ]
)
"""Scattering of air at the ground [km^-1]."""
_OZONE = (
    np.array(
        [
            0.0032512685,
            0.00585395365,
            0.0197719116,
            0.0730956876,
            0.200845615,
            0.403839581,
            0.635513359,
            0.967070412,
            1.547974,
            2.09038647,
            2.46128056,
            2.73551299,
            2.15125863,
            1.59051841,
            1.12356198,
            0.735275515,
            0.464501304,
            0.330960799,
            0.225126123,
            0.148791293,
            0.168286234,
        ]
    )
    / 1000
)
"""Absorption of ozone where it is densest [km^-1]."""
_X = [1.368, 14.31, 134.38, 348.28, 290.8, 95.64, 4.9, 63.27, 290.4, 594.5, 916.3, 1062.2, 854.4499, 447.9, 164.9, 46.77, 11.35916]
_Y = [0.039, 0.396, 4.0, 23.0, 60.0, 139.02, 323.0, 710.0, 954.0, 995.0, 870.0, 631.0, 381.0, 175.0, 61.0, 17.0, 4.102]
_Z = [6.450001, 67.85001, 645.6, 1747.06, 1669.2, 812.9501, 272.0, 78.24999, 20.3, 3.9, 1.650001, 0.8, 0.19, 0.02, 0.0, 0.0, 0.0]
_REST = [[2.899327, 0.6900786, 0.1661505, 0.04150994], [1.047, 0.2492, 0.06, 0.01499], [0.0, 0.0, 0.0, 0.0]]
_OBSERVER = np.hstack(([_X, _Y, _Z], _REST)) / 1000
"""Colour matching functions (3, 21): CIE 1931, 2 degrees."""
_NODES, _WEIGHTS = np.polynomial.laguerre.laggauss(8)
_END = 25.0
"""Gauss-Laguerre quadrature over [0, inf) of optical depths, cut off where the atmosphere ends."""


def single_scattering(elevations, azimuths, sun_elevation, altitude, air, haze, ozone):
    """Radiance (3, len(elevations), len(azimuths)), linear Rec. 709, unclipped; azimuths from the sun's on [rad].

    altitude [km] of the viewer; air, haze, ozone: densities, 1 as on a clear day. The bottom of the sky has the elevation 0.
    """
    elevation, azimuth = np.meshgrid(elevations, azimuths, indexing="ij")
    d = np.stack((np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation))).reshape(3, -1)
    towards = np.array([np.cos(sun_elevation), 0.0, np.sin(sun_elevation)])[:, None]
    scale = np.array([air, haze, ozone], np.float64)[:, None]
    eye = np.array([0.0, 0.0, EARTH + altitude])[:, None]
    step = _way_out(eye, d) / _STEPS
    cosine = (d * towards).sum(axis=0)
    air_phase, haze_phase = _air_phase(cosine), _haze_phase(cosine)
    depth = np.zeros_like(d)
    spectrum = np.zeros((21, d.shape[1]), np.float32)
    for i in range(_STEPS):
        p = eye + (i + 0.5) * step * d
        density = scale * _density(p)
        depth += step * density
        lit = np.nonzero(~_in_shadow(p, towards))[0]
        total = depth[:, lit] + scale * _optical_depth(p[:, lit], towards)
        scattered = (air_phase * density[0] * step)[lit], (haze_phase * density[1] * step * _HAZE)[lit]
        spectrum[:, lit] += _transmittance(total) * (np.multiply.outer(_AIR, scattered[0]) + scattered[1])
    return _colour(_SUN[:, None] * spectrum).reshape(3, *elevation.shape)


def sun_disk(sun_elevation, size, altitude, air, haze):
    """Radiance (3,) at the lower and upper edge of the sun, of angular diameter `size`; black where it has set."""
    solid_angle = 4 * np.pi * np.sin(0.25 * size) ** 2
    lower, upper = (max(sun_elevation + side * size, 0.0) for side in (-0.5, 0.5))
    if upper == 0:
        return np.zeros(3), np.zeros(3)
    scale = np.array([air, haze, 0.0])[:, None]
    eye = np.array([0.0, 0.0, EARTH + altitude])[:, None]
    edges = (np.array([np.cos(e), 0.0, np.sin(e)])[:, None] for e in (lower, upper))
    return tuple(_colour(_SUN[:, None] * _transmittance(scale * _optical_depth(eye, d)))[:, 0] / solid_angle for d in edges)


def _density(p):
    """Air, haze and ozone at p (3, N), each relative to where it is densest."""
    height = np.sqrt((p * p).sum(axis=0)) - EARTH
    layer = np.maximum(1 - np.abs(height - 25) / 15, 0)
    return np.stack((np.exp(-height / _AIR_HEIGHT), np.exp(-height / _HAZE_HEIGHT), layer))


def _way_out(p, d):
    """Distance (N,) from p to the end of the atmosphere along d."""
    b = (p * d).sum(axis=0)
    return -b + np.sqrt(b * b - (p * p).sum(axis=0) + _TOP**2)


def _in_shadow(p, towards):
    b = (p * towards).sum(axis=0)
    return (towards[2] < 0) & (b * b >= (p * p).sum(axis=0) - EARTH**2)


def _optical_depth(p, d):
    """The integral of `_density` from p (3, N) along d (3, 1) [km], (3, N)."""
    length = _way_out(p, d)
    nodes = zip(_NODES / _END, _WEIGHTS * np.exp(_NODES) / _END)
    return sum(weight * _density(p + node * length * d) for node, weight in nodes) * length


def _transmittance(depth):
    """(21, N) of optical depths (3, N) of air, haze and ozone."""
    extinction = np.stack((_AIR, np.full(21, _ABSORBED * _HAZE), _OZONE), axis=1)
    return np.exp(-(extinction @ depth).astype(np.float32))


def _air_phase(cosine):
    return 3 / (16 * np.pi) * (1 + cosine**2)


def _haze_phase(cosine):
    g2 = _G * _G
    return 3 * (1 - g2) * (1 + cosine**2) / (8 * np.pi * (2 + g2) * (1 + g2 - 2 * _G * cosine) ** 1.5)


def _colour(spectrum):
    return (FROM_XYZ @ _OBSERVER * _STEP_WAVELENGTH) @ spectrum
