"""Sky Texture nodes."""

import math
from dataclasses import replace

import numpy as np

from ...engine import Coordinates, LinearTexture, PreethamSky, SkyTexture, SunLight
from .colours import terms_of, varies

_HOSEK = 0.18
"""The light of Hosek's sky over that of Preetham's in Blender: 0.1 to 0.24, by turbidity and the sun's place."""
_DIRECTION = Coordinates(source="generated")


def _sky(reader, node, output):
    where = reader.vector(node, _DIRECTION)
    if node.sky_type in ("PREETHAM", "HOSEK_WILKIE"):
        sky = PreethamSky(where, tuple(float(c) for c in node.sun_direction), min(max(node.turbidity, 1.0), 30.0))
        if node.sky_type == "PREETHAM":
            return sky
        reader.note("the sky of Hosek and Wilkie is rendered as Preetham's, in about its brightness")
        return LinearTexture((sky,), (_HOSEK,))
    if node.sky_type == "MULTIPLE_SCATTERING":
        reader.note("light that the sky has scattered several times is left out: the sky is rendered as Single Scattering")
    elevation, rotation = _place(node.sun_elevation, node.sun_rotation)
    aerosols = node.aerosol_density if hasattr(node, "aerosol_density") else node.dust_density
    densities = node.air_density, aerosols, node.ozone_density
    angle = node.sun_size if node.sun_disc else 0.0
    return SkyTexture(where, elevation, rotation, node.altitude, *densities, angle, node.sun_intensity)


def without_sun(radiance):
    """(radiance, `SunLight` or None): the disc of the sun of a world that is but one sky, scaled, as a light that is easily found."""
    terms = terms_of(radiance)
    if len(terms.textures) != 1 or varies(terms.factors[0]) or type(terms.textures[0]) is not SkyTexture:
        return radiance, None
    (sky,), (factor,) = terms.textures, terms.factors
    if not sky.sun_angle or not _is_upright(sky.coordinates):
        return radiance, None
    irradiance = tuple((sky.sun_irradiance * factor).tolist())
    sun = SunLight(name="Sky", towards=sky.sun, irradiance=irradiance, angle=sky.sun_angle, is_visible=True)
    return replace(terms, textures=(replace(sky, sun_angle=0.0),)), sun


def _is_upright(coordinates):
    return isinstance(coordinates, Coordinates) and np.array_equal(np.array(coordinates.matrix), np.eye(4))


def _place(elevation, rotation):
    """Elevation within [-pi/2, pi/2], and the rotation that goes with it."""
    elevation = math.remainder(elevation, 2 * math.pi)
    if abs(elevation) > 0.5 * math.pi:
        return math.copysign(math.pi, elevation) - elevation, rotation + math.pi
    return elevation, rotation


TABLE = {"TEX_SKY": _sky}
