"""Daylight scattered many times, by the fit of F. García Liñán ("Fast spectral rendering of the atmosphere", 2024; fgarlin.com).

Four wavelengths stand for the spectrum: 630, 560, 490 and 430 nm. Along each ray what is scattered once is added up exactly, what has been
scattered more often is a fit, and includes what the ground reflects. Lengths in kilometres; the sun stands in the plane of z and x.
The constants: see LICENSES/MIT.txt.
"""

import numpy as np

from .observer import FROM_XYZ

EARTH = 6371.0
"""Radius of the ground [km]."""
_TOP = EARTH + 100.0
_STEPS = 64
_G = 0.8
_ALBEDO = 0.3
"""Of the ground."""
_SUN = np.array([1.679, 1.828, 1.986, 1.307])[:, None]
_AIR = np.array([6.605e-3, 1.067e-2, 1.842e-2, 3.156e-2])[:, None]
_OZONE = np.array([0.04396389, 0.04956067, 0.01708159, 0.001396664])[:, None]
_HAZE_SCATTERS = np.array([0.02176373, 0.02423042, 0.02865075, 0.03287955])[:, None]
_HAZE_ABSORBS = np.array([0.3929457, 0.6316244, 1.090458, 1.857606])[:, None] / 1000
_HAZE_FAR_UP = 2e6 / 1.3681e20
"""At the ground, and of ozone times a height: coefficients [km^-1] of a clear day."""
_LOWEST = 0.1 / 1000
"""Below this height [km] ozone does not thin out any more."""
_OFTEN = 0.02 * np.array([0.217, 0.347, 0.594, 1.0])[:, None]
"""What is scattered more than once, under a high sun."""
_XYZ = np.array(
    [
        [53.386917738564668, 43.904844466369358, 1.6137278251608962, 20.762668673810577],
        [22.981337506691025, 71.347795700053393, 18.422960591455485, 2.3614213523314369],
        [0.0, 0.10250686796574131, 31.742921188390806, 110.48009643252140],
    ]
)
_SHAPE = (64, 256)
"""Heights and cosines at which transmittances are tabulated."""


def multiple_scattering(elevations, azimuths, sun_elevation, altitude, air, haze, ozone):
    """Radiance (3, len(elevations), len(azimuths)), linear Rec. 709, unclipped; azimuths from the sun's on [rad].

    altitude [km] of the viewer; air, haze, ozone: densities, 1 as on average. Below the horizon is the haze before a black ground.
    """
    densities = air, haze, ozone
    table = _transmittances(densities)
    elevation, azimuth = np.meshgrid(elevations, azimuths, indexing="ij")
    d = np.stack((np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation))).reshape(3, -1)
    towards = np.array([np.cos(sun_elevation), 0.0, np.sin(sun_elevation)])[:, None]
    eye = np.array([0.0, 0.0, EARTH + altitude])[:, None]
    cosine = (d * towards).sum(axis=0)
    air_phase = 3 / (16 * np.pi) * (1 + cosine**2)
    haze_phase = (1 - _G * _G) / (4 * np.pi * (1 + _G * _G - 2 * _G * cosine) ** 1.5)
    step = _length(eye, d) / _STEPS
    L, through = np.zeros((4, d.shape[1])), np.ones((4, d.shape[1]))
    for i in range(_STEPS):
        p = eye + (i + 0.5) * step * d
        distance = np.sqrt((p * p).sum(axis=0))
        sun_cosine = (p * towards).sum(axis=0) / distance
        height = np.maximum(distance - EARTH, 0)
        by_air, by_haze, extinction = _coefficients(height, densities)
        direct, often = _transmittance_at(table, height, sun_cosine), _often(table, height, sun_cosine, distance)
        source = _SUN * (by_air * (air_phase * direct + often) + by_haze * (haze_phase * direct + often))
        # The integral over the step of what is scattered, weakened on its way back (Hillaire 2015).
        left = np.exp(-step * extinction)
        L += through * source * (1 - left) / extinction
        through *= left
    return (FROM_XYZ @ _XYZ @ L).reshape(3, *elevation.shape)


def sun_disk(sun_elevation, size, altitude, air, haze, ozone):
    """Radiance (3,) at the lower and upper edge of the sun, of angular diameter `size`."""
    solid_angle = 4 * np.pi * np.sin(0.25 * size) ** 2
    cosines = np.sin(sun_elevation + np.array([-0.5, 0.5]) * size)
    L = FROM_XYZ @ _XYZ @ (_SUN * _transmittance(np.full(2, altitude), cosines, (air, haze, ozone))) / solid_angle
    return L[:, 0], L[:, 1]


def _coefficients(height, densities):
    """[km^-1] (4, N) at heights (N,): scattering by air and by haze, and extinction."""
    air, haze, ozone = densities
    by_air = air * _AIR * np.exp(-0.07771971 * height**1.16364243)
    log = np.log(np.maximum(height, _LOWEST))
    by_ozone = ozone * _OZONE * np.exp(-5.55555555 * (log - 3.22261) ** 2 - log)
    density = haze * (np.exp(-height / 0.73) + _HAZE_FAR_UP)
    by_haze = density * _HAZE_SCATTERS
    return by_air, by_haze, np.maximum(by_air + by_ozone + by_haze + density * _HAZE_ABSORBS, np.finfo(np.float32).tiny)


def _length(p, d):
    """How far rays go from p (3, 1) along d (3, N): to the ground, or to the end of the atmosphere."""
    b, c = (p * d).sum(axis=0), (p * p).sum(axis=0)
    to_ground = b * b - c + EARTH**2
    out = -b + np.sqrt(b * b - c + _TOP**2)
    return np.where((b < 0) & (to_ground >= 0), -b - np.sqrt(np.maximum(to_ground, 0)), out)


def _transmittance(height, cosine, densities):
    """(4, N) from heights [km] (N,) out of the atmosphere, at a cosine from the zenith; the ground is in nobody's way."""
    r = EARTH + height
    step = (-r * cosine + np.sqrt((r * cosine) ** 2 - r * r + _TOP**2)) / _STEPS
    depth = 0
    for i in range(_STEPS):
        t = (i + 0.5) * step
        distance = np.sqrt(r * r + 2 * r * cosine * t + t * t)
        depth = depth + step * _coefficients(np.maximum(distance - EARTH, 0), densities)[2]
    return np.exp(-depth)


def _transmittances(densities):
    """(4, 64 * 256): by height, from the ground up, and cosine, from -1 to 1."""
    height, cosine = np.meshgrid(np.linspace(0, _TOP - EARTH, _SHAPE[0]), np.linspace(-1, 1, _SHAPE[1]), indexing="ij")
    return _transmittance(height.ravel(), cosine.ravel(), densities)


def _transmittance_at(table, height, cosine):
    """(4, N), interpolated."""
    y = np.clip(height / (_TOP - EARTH), 0, 1) * (_SHAPE[0] - 1)
    x = np.clip(0.5 * cosine + 0.5, 0, 1) * (_SHAPE[1] - 1)
    row, column = (np.minimum(a.astype(np.intp), n - 2) for a, n in zip((y, x), _SHAPE))
    a, b = y - row, x - column
    at = row * _SHAPE[1] + column
    below, above = ((1 - b) * table.take(at + k, axis=1) + b * table.take(at + k + 1, axis=1) for k in (0, _SHAPE[1]))
    return (1 - a) * below + a * above


def _often(table, height, sun_cosine, distance):
    """What reaches a height (N,) after more than one scattering, by any way, per irradiance of the sun (4, N)."""
    ground = 2 * np.pi * (1 - np.sqrt(np.maximum(1 - (EARTH / distance) ** 2, 0)))
    zenith = np.ones(1)
    up = _transmittance_at(table, np.zeros(1), zenith) / _transmittance_at(table, height, np.ones_like(height))
    reflected = ground / (4 * np.pi) * _ALBEDO / np.pi * _transmittance_at(table, np.zeros_like(height), sun_cosine) * up * sun_cosine
    return _OFTEN / (1 + 5 * np.exp(-17.92 * sun_cosine)) + reflected
