"""The light of a clear sky: sunlight scattered once in a round atmosphere, wavelength by wavelength.

Nishita, Sirai, Tadamura and Nakamae 1993, "Display of the Earth Taking into Account Atmospheric Scattering". Air and aerosols
thin out exponentially, ozone is a layer around 25 km (Bruneton 2017, "A Qualitative and Quantitative Evaluation of 8 Clear Sky
Models"). Lengths are in metres, wavelengths in nanometres, radiance in W m^-2 sr^-1 per channel of linear Rec. 709.
"""

from functools import lru_cache

import numpy as np

from .spectrum import FROM_XYZ

EARTH, TOP = 6360e3, 6420e3
"""Radii of the earth and of the atmosphere."""
_RAYLEIGH_HEIGHT, _MIE_HEIGHT = 8e3, 1.2e3
_WAVELENGTHS = np.arange(380.0, 781.0, 20.0)
_RAYLEIGH = 1131148.7658 * _WAVELENGTHS**-4
"""Scattering of air at sea level [m^-1]: Rayleigh's law."""
_MIE, _MIE_EXTINCTION, _G = 1 / 50e3, 1.11 / 50e3, 0.76
"""Scattering and extinction of aerosols at sea level [m^-1], and the mean cosine of the angle that they scatter by."""
_OZONE = np.fromstring(
    "3.2513 5.8540 19.772 73.096 200.85 403.84 635.51 967.07 1547.97 2090.39 2461.28 2735.51 2151.26 1590.52 1123.56 735.28 464.50 "
    "330.96 225.13 148.79 168.29",
    sep=" ",
) / 1e9
"""Absorption of ozone where it is densest [m^-1]."""
_MATCHING = np.fromstring(
    "0.001368 0.01431 0.13438 0.34828 0.2908 0.09564 0.0049 0.06327 0.2904 0.5945 0.9163 1.0622 0.8544499 0.4479 0.1649 0.04677 "
    "0.01135916 0.002899327 0.0006900786 0.0001661505 0.00004150994 "
    "0.000039 0.000396 0.004 0.023 0.06 0.13902 0.323 0.71 0.954 0.995 0.87 0.631 0.381 0.175 0.061 0.017 0.004102 0.001047 "
    "0.0002492 0.00006 0.00001499 "
    "0.006450001 0.06785001 0.6456 1.74706 1.6692 0.8129501 0.272 0.07824999 0.0203 0.0039 0.001650001 0.0008 0.00019 0.00002 "
    "0 0 0 0 0 0 0",
    sep=" ",
).reshape(3, -1)
"""The CIE 1931 observer (CIE 15:2004, table 4)."""
_STEPS, _NODES = 32, 8
_LAGUERRE_END = 25.0


def _planck(temperature):
    """Radiance of a black body [W m^-2 sr^-1 nm^-1]."""
    # c_1 / pi and c_2 (CODATA 2018), for nanometres.
    return 1.1910429724e20 / _WAVELENGTHS**5 / np.expm1(1.438776877e7 / (_WAVELENGTHS * temperature))


_SUN = np.pi * 0.00464906**2 * _planck(5778.0)
"""Irradiance of the sun [W m^-2 nm^-1] above the atmosphere: a black body of 5778 K, with this radius [rad]."""


def _rgb(spectrum):
    """(3, ...) of a spectrum (21, ...)."""
    weights = FROM_XYZ @ _MATCHING * (_WAVELENGTHS[1] - _WAVELENGTHS[0])
    return np.maximum(np.tensordot(weights, spectrum, 1), 0)


def _densities(height):
    """Of air, aerosols and ozone (3, ...) at a height."""
    ozone = np.maximum(0, 1 - np.abs(height - 25000) / 15000)
    return np.stack((np.exp(-height / _RAYLEIGH_HEIGHT), np.exp(-height / _MIE_HEIGHT), ozone))


def _to_top(p, d):
    """How far it is from points p (2 or 3, ...) along d to the top of the atmosphere."""
    b = (p * d).sum(axis=0)
    return np.sqrt(np.maximum(b * b - (p * p).sum(axis=0) + TOP * TOP, 0)) - b


def _depth_to_top(p, d):
    """Optical depths (3, ...) from p along d, by densities: Gauss-Laguerre quadrature, as they fall off exponentially."""
    nodes, weights = np.polynomial.laguerre.laggauss(_NODES)
    length = _to_top(p, d)
    total = 0
    for node, weight in zip(nodes / _LAGUERRE_END, weights * np.exp(nodes) / _LAGUERRE_END):
        q = p + node * length * d
        total = total + weight * _densities(np.sqrt((q * q).sum(axis=0)) - EARTH)
    return total * length


def _scattered(d, sun, altitude, density):
    """Radiance (3, N) of the sky in directions d (3, N)."""
    mu = np.tensordot(sun, d, 1)
    rayleigh = 3 / (16 * np.pi) * (1 + mu * mu)
    mie = 3 * (1 - _G**2) * (1 + mu * mu) / (8 * np.pi * (2 + _G**2) * (1 + _G**2 - 2 * _G * mu) ** 1.5)
    eye = np.array((0.0, 0.0, EARTH + altitude))[:, None]
    step = _to_top(eye, d) / _STEPS
    depth, total = 0, 0
    for i in range(_STEPS):
        p = eye + (i + 0.5) * step * d
        here = density * _densities(np.sqrt((p * p).sum(axis=0)) - EARTH)
        depth = depth + step * here
        b = np.tensordot(sun, p, 1)
        is_lit = (sun[2] >= 0) | (b * b - (p * p).sum(axis=0) + EARTH * EARTH < 0)
        way = depth + density * _depth_to_top(p, sun[:, None])
        extinct = np.multiply.outer(_RAYLEIGH, way[0]) + _MIE_EXTINCTION * way[1] + np.multiply.outer(_OZONE, way[2])
        scattered = np.multiply.outer(_RAYLEIGH, rayleigh * here[0]) + _MIE * mie * here[1]
        total = total + np.exp(-extinct) * scattered * (step * is_lit)
    return _rgb(total * _SUN[:, None])


@lru_cache(maxsize=8)
def sky_table(elevation, altitude, air, aerosols, ozone, shape=(96, 96)):
    """Radiance (3, rows, columns) float32 of a sky with the sun at `elevation` [rad], over the upper hemisphere.

    Row r is at the elevation pi/2 (r / (rows - 1))^2, column c at the azimuth pi c / (columns - 1) from the sun. `air`,
    `aerosols` and `ozone` scale the densities; `altitude` [m] is the eye's.
    """
    rows, columns = shape
    up = 0.5 * np.pi * np.linspace(0, 1, rows)[:, None] ** 2
    around = np.linspace(0, np.pi, columns)
    d = np.stack((np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up) + 0 * around))
    sun = np.array((np.cos(elevation), 0.0, np.sin(elevation)))
    density = np.array((air, aerosols, ozone))[:, None]
    parts = [_scattered(d[:, row], sun, min(max(altitude, 1.0), TOP - EARTH - 1), density) for row in range(rows)]
    return np.stack(parts, axis=1).astype(np.float32)


def sun_radiance(elevation, angle, altitude, air, aerosols):
    """Radiance (3,) of the middle of the sun's disc at `elevation`, seen through air and aerosols; `angle` [rad] is its diameter.

    The mean of its lowest and its highest place; black where all of it has set.
    """
    eye = np.array((0.0, 0.0, EARTH + min(max(altitude, 1.0), TOP - EARTH - 1)))
    if elevation + 0.5 * angle <= 0:
        return np.zeros(3)
    up = np.maximum(elevation + 0.5 * angle * np.array((-1.0, 1.0)), 0)
    way = _depth_to_top(eye[:, None], np.stack((np.cos(up), 0 * up, np.sin(up))))
    extinct = np.multiply.outer(_RAYLEIGH, way[0] * air) + _MIE_EXTINCTION * way[1] * aerosols
    return _rgb(_SUN[:, None] * np.exp(-extinct) / (2 * np.pi * (1 - np.cos(0.5 * angle)))).mean(axis=1)


LIMB = 0.6
"""How much darker the sun is at its rim: 1 - LIMB (1 - sqrt(1 - r^2)) of the middle at the share r of its radius."""
MEAN_OF_DISC = 1 - LIMB / 3
"""The mean of that over the disc."""
