"""Blender's lights as the engine's, in exactly Blender's units.

Every light has a strength S = colour * energy * 2^exposure * colour temperature * (colour * strength of its Emission
node). With `normalize` off, S counts per bulb or area instead of in all. Exposure, temperature and `normalize` exist
from Blender 4.5 on.
"""

import math

import bpy
import numpy as np

from ...engine import AreaLight, CosineSpotLight, PointLight, Shade, SpotLight, SunLight
from .colours import as_texture, varies
from .findings import IGNORED
from .missing import note_missing
from .nodes import has_nodes, output_node
from .shaders import surface_of

LIGHTS_ARE_OBJECTS = (4, 5)
"""The Blender from which on lights of Cycles have a frame and values as objects have."""
SMALLEST_SPREAD = math.radians(0.1)
"""Blender allows a spread of 0, which no light has."""
_ENDLESS = 1024
"""The Max Bounces of lights in Cycles unless they are limited."""
_ROUND = ("DISK", "ELLIPSE")
_SCATTERED = ("diffuse", "glossy", "transmission")


def export_light(light_object, matrix, findings, emissions, values_of=lambda names: ()):
    """The engine's light for a light object (evaluated) placed by `matrix` (4, 4), or None where it gives no light.

    emissions  the `Emissions` of all lights
    values_of  `Object.values` of the light by their names, for textures that ask for them
    """
    light = light_object.data
    name = f"light '{light_object.name}'"
    note_missing(light, name, findings)
    if getattr(getattr(light, "cycles", None), "is_portal", False):
        findings.note("light portals are ignored", name)
        return None
    note_ignored(light_object, light, name, findings)
    emission = emissions.of(light, name)
    shade, S = None, strength(light)
    if varies(emission):
        asked = sorted(name for source, name in Shade(texture=emission).attributes if source == "value")
        shade = Shade(texture=emission, world_from_light=matrix, values=values_of(asked))
    else:
        S = S * emission
    if S.min() < 0:
        findings.note("it would take light away, so it is left out", name, IGNORED)
        return None
    hidden = tuple(kind for kind in _SCATTERED if not getattr(light_object, f"visible_{kind}"))
    common = {"name": light_object.name, "is_visible": bool(light_object.visible_camera), "hidden_from": hidden, "shade": shade}
    common["group"] = light_object.lightgroup
    return _KINDS[light.type](light, matrix, S, common, name, findings)


class Emissions:
    """Colour times strength of the Emission nodes of lights: three numbers or a texture, read once for all that share a light."""

    def __init__(self, findings, bitmaps):
        self._findings, self._bitmaps = findings, bitmaps
        self._known = {}

    def of(self, light, name):
        """What the nodes of `light` (evaluated) give; `name` is that of the light in notes."""
        key = light.original.as_pointer()
        if key not in self._known:
            self._known[key] = self._read(light, name)
        return self._known[key]

    def _read(self, light, name):
        if not has_nodes(light):
            return (1.0, 1.0, 1.0)
        output = output_node(light.node_tree)
        if output is None:
            self._findings.note("the node tree has no active output, so the light is dark", name)
            return (0.0, 0.0, 0.0)
        emission = as_texture(surface_of(output, name, self._findings, self._bitmaps).emission)
        if varies(emission) and bpy.app.version < LIGHTS_ARE_OBJECTS and _asks_for_frame(emission):
            self._findings.note("its textures are asked in its own frame, as from Blender 4.5 on; before, Cycles took the world's", name)
        return emission


def _asks_for_frame(texture):
    return not {"object", "generated", "camera", "value"}.isdisjoint(source for source, _ in Shade(texture=texture).attributes)


def strength(light):
    """S without nodes, (3,) float64, in the unit of the light's kind."""
    S = np.array(light.color, np.float64) * light.energy * 2.0 ** getattr(light, "exposure", 0.0)
    if getattr(light, "use_temperature", False):
        S = S * np.array(light.temperature_color, np.float64)
    return S


def note_ignored(light_object, light, name, findings):
    """Note what Blender can ask of a light and Glanz does not do."""
    if not getattr(light, "use_shadow", True):
        findings.note("the light casts shadows although they are switched off", name, IGNORED)
    if getattr(getattr(light, "cycles", None), "max_bounces", _ENDLESS) < _ENDLESS:
        findings.note("its Max Bounces are ignored, it shines however often light has bounced", name, IGNORED)
    linking = getattr(light_object, "light_linking", None)
    if linking and (linking.receiver_collection or linking.blocker_collection):
        findings.note("light linking is ignored, the light reaches everything", name, IGNORED)


def _bulb_intensity(light, S):
    """Radiant intensity [W sr^-1] of point and spot lights."""
    factor = 1.0
    if not getattr(light, "normalize", True):
        r = light.shadow_soft_size
        factor = 4 * math.pi * r * r if r > 0 else 4.0
    return tuple((S * (factor / (4 * math.pi))).tolist())


def _point(light, matrix, S, common, name, findings):
    return PointLight(
        position=tuple(matrix[:3, 3].tolist()),
        intensity=_bulb_intensity(light, S),
        radius=light.shadow_soft_size,
        soft_falloff=light.use_soft_falloff,
        **common,
    )


def _spot(light, matrix, S, common, name, findings):
    bulb = {
        "world_from_light": matrix,
        "intensity": _bulb_intensity(light, S),
        "radius": light.shadow_soft_size,
        "soft_falloff": light.use_soft_falloff,
    }
    if light.glanz.characteristic == "COSINE":
        return CosineSpotLight(exponent=light.glanz.exponent, **bulb, **common)
    return SpotLight(angle=min(light.spot_size, math.pi), blend=light.spot_blend, **bulb, **common)


def _sun(light, matrix, S, common, name, findings):
    axis = matrix[:3, 2]
    length = np.linalg.norm(axis)
    if not length > 0:
        findings.note("the light's scale leaves it no direction, so it is left out", name, IGNORED)
        return None
    angle = min(light.angle, math.pi)
    if not getattr(light, "normalize", True) and angle > 0:
        S = S * math.pi * math.sin(0.5 * angle) ** 2
    return SunLight(towards=tuple((axis / length).tolist()), irradiance=tuple(S.tolist()), angle=angle, **common)


def _area(light, matrix, S, common, name, findings):
    size_y = light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
    shape = {"world_from_light": matrix, "size_x": light.size, "size_y": size_y, "is_ellipse": light.shape in _ROUND}
    area = AreaLight(**shape).area()
    if not area > 0:
        findings.note("the light has no area, so it is left out", name)
        return None
    per_area = math.pi * (area if getattr(light, "normalize", True) else 1.0)
    spread = min(max(light.spread, SMALLEST_SPREAD), math.pi)
    return AreaLight(radiance=tuple((S / per_area).tolist()), spread=spread, **shape, **common)


_KINDS = {"POINT": _point, "SPOT": _spot, "SUN": _sun, "AREA": _area}
