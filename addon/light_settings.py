"""What Glanz asks of a light beyond Blender's own settings: `light.glanz`."""

import bpy
from bpy.props import EnumProperty, FloatProperty, PointerProperty

from .properties import renew


class GlanzLightSettings(bpy.types.PropertyGroup):
    """How a spot light of Blender shines in Glanz."""

    characteristic: EnumProperty(
        name="Characteristic",
        description="How the light of a spot falls off with the angle from its axis",
        items=(
            ("CONE", "Cone", "Blender's cone with a soft edge: Spot Size and Blend count"),
            ("COSINE", "Cosine Power", "A power of the cosine of the angle, without an edge: Spot Size and Blend do not count"),
        ),
        default="CONE",
        update=renew,
    )
    exponent: FloatProperty(
        name="Exponent",
        description=(
            "Power n of the cosine, without a unit: radiant intensity is that of the axis times cos^n. "
            "0 lights the half space in front evenly, larger is narrower; the brightness on the axis stays"
        ),
        default=8.0,
        min=0.0,
        soft_max=1000.0,
        max=1e6,
        update=renew,
    )


def register():
    bpy.utils.register_class(GlanzLightSettings)
    bpy.types.Light.glanz = PointerProperty(type=GlanzLightSettings, name="Glanz", description="What Glanz asks of a light")


def unregister():
    del bpy.types.Light.glanz
    bpy.utils.unregister_class(GlanzLightSettings)
