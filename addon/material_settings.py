"""What Glanz asks of a material beyond Blender's own settings: `material.glanz`."""

import bpy
from bpy.props import FloatProperty, IntProperty, PointerProperty


class GlanzMaterialSettings(bpy.types.PropertyGroup):
    """What is inside of objects that wear a material, in Glanz."""

    priority: IntProperty(
        name="Priority",
        description=(
            "Where objects that let light in overlap, the inside of the highest priority is there and the others are not; "
            "of equal ones that of the smaller object. A glass of water: give the glass 1, and let the water reach into its wall"
        ),
        default=0,
        soft_min=-10,
        soft_max=10,
    )
    abbe: FloatProperty(
        name="Abbe Number",
        description=(
            "Dispersion of glass: Abbe number, without a unit; 0 = none. Small numbers spread colours more: "
            "crown glass has 64, water 56, diamond 55, flint glass 30. The index of refraction then is that of yellow light"
        ),
        default=0.0,
        min=0.0,
        soft_max=100.0,
        max=1e6,
    )


def register():
    bpy.utils.register_class(GlanzMaterialSettings)
    bpy.types.Material.glanz = PointerProperty(type=GlanzMaterialSettings, name="Glanz", description="What Glanz asks of a material")


def unregister():
    del bpy.types.Material.glanz
    bpy.utils.unregister_class(GlanzMaterialSettings)
