"""Sky Texture nodes, in all models of all versions of Blender."""

import math

from ...engine import Coordinates, SkyTexture
from .mapping import note_mapping

_DIRECTION = Coordinates(source="generated")
_MODELS = {
    "PREETHAM": "preetham",
    "HOSEK_WILKIE": "hosek wilkie",
    "NISHITA": "nishita",
    "SINGLE_SCATTERING": "single scattering",
    "MULTIPLE_SCATTERING": "multiple scattering",
}
_SMALLEST_SUN = 0.0005
"""Angular diameter [rad] of the smallest sun in Cycles."""


def _sky(reader, node, output):
    note_mapping(reader, node)
    where = {"coordinates": reader.vector(node, _DIRECTION)}
    model = _MODELS[node.sky_type]
    if model in ("preetham", "hosek wilkie"):
        x, y, z = node.sun_direction
        length = math.hypot(x, y, z)
        # What is not finite is no unit vector, which the engine refuses.
        towards = (x / length, y / length, z / length) if length else (0.0, 0.0, 1.0)
        return SkyTexture(model, sun_direction=towards, turbidity=node.turbidity, ground_albedo=node.ground_albedo, **where)
    elevation, rotation = _above(node.sun_elevation, node.sun_rotation)
    return SkyTexture(
        model,
        has_disk=node.sun_disc,
        sun_size=max(node.sun_size, _SMALLEST_SUN),
        sun_intensity=node.sun_intensity,
        sun_elevation=elevation,
        sun_rotation=rotation,
        altitude=node.altitude,
        air=node.air_density,
        haze=node.aerosol_density if hasattr(node, "aerosol_density") else node.dust_density,
        ozone=node.ozone_density,
        **where,
    )


def _above(elevation, rotation):
    """The same place of the sun with an elevation from -pi / 2 to pi / 2: a sun that has passed the zenith is on the other side."""
    if not (math.isfinite(elevation) and math.isfinite(rotation)):
        # For the engine to refuse, with its name.
        return elevation, rotation
    elevation = math.remainder(elevation, 2 * math.pi)
    if abs(elevation) > 0.5 * math.pi:
        return math.copysign(math.pi, elevation) - elevation, math.remainder(rotation + math.pi, 2 * math.pi)
    return elevation, math.remainder(rotation, 2 * math.pi)


TABLE = {"TEX_SKY": _sky}
