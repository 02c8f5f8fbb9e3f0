"""What Glanz asks of a material beyond Blender's own settings: `material.glanz`."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty

from .properties import renew


def _coefficient(name, description, default):
    """A share of light for each of red, green and blue."""
    return FloatVectorProperty(
        name=name,
        description=f"{description}. No unit, linear, 0 to 1",
        default=(default,) * 3,
        min=0.0,
        max=1.0,
        size=3,
        subtype="COLOR",
        update=renew,
    )


_MORE_RAYS = "; above 0 Whitted's ray tracing follows one ray more from each hit, which takes its time"


class GlanzMaterialSettings(bpy.types.PropertyGroup):
    """The lecture's parameters of a material, and what is inside of objects that wear it, in Glanz."""

    use_lecture: BoolProperty(
        name="Lecture Material",
        description="Go by the lecture's parameters below, and not by the material's nodes",
        default=False,
        update=renew,
    )
    k_a: _coefficient(
        "Ambient k_a", "Share of every light's irradiance that arrives everywhere; only Whitted (Phong Illumination) knows it", 0.0
    )
    k_d: _coefficient("Diffuse k_d", "Share of light that is reflected evenly into all directions", 0.5)
    k_s: _coefficient("Specular k_s", "Share of light in the highlight about the mirror direction; that of metals is coloured", 0.3)
    exponent: FloatProperty(
        name="Exponent n",
        description="Power of the cosine in the highlight, without a unit: 0 is as dull as can be, 1000 a small sharp highlight",
        default=32.0,
        min=0.0,
        soft_max=1000.0,
        max=1e6,
        update=renew,
    )
    normalisation: EnumProperty(
        name="Normalisation",
        description="How the highlight is made a share of light. All three look alike seen straight, and differ towards grazing angles",
        items=(
            ("phong", "Modified Phong", "(n + 2) / (2 pi) cos^n, reciprocal; never more than k_s (Lafortune and Willems 1994)"),
            ("phong_lecture", "Lecture", "The same over the cosine of incidence: not reciprocal, up to k_s (n + 2) / (n + 1)"),
            ("blinn_phong", "Blinn-Phong", "cos^n of the half vector, reciprocal; seen straight as wide as the others with a quarter of n"),
        ),
        default="phong",
        update=renew,
    )
    k_r: _coefficient("Reflection k_r", f"Share of light that is reflected as by a mirror{_MORE_RAYS}", 0.0)
    k_t: _coefficient("Transmission k_t", f"Share of light that passes the surface{_MORE_RAYS}", 0.0)
    is_sheet: BoolProperty(
        name="Thin Sheet",
        description=(
            "What passes is scattered about its way straight on, as by paper or frosted glass, and has no inside. "
            "Off: it is refracted into the body, which should be closed"
        ),
        default=False,
        update=renew,
    )
    sheet_exponent: FloatProperty(
        name="Sheet Exponent",
        description="Power of the cosine about the way straight on, without a unit: 0 scatters like paper, 1000 is nearly clear",
        default=8.0,
        min=0.0,
        soft_max=1000.0,
        max=1e6,
        update=renew,
    )
    ior: FloatProperty(
        name="IOR",
        description="Index of refraction of the inside, without a unit: 1 bends nothing, water has 1.33, glass 1.5, diamond 2.42",
        default=1.5,
        min=1e-3,
        soft_min=1.0,
        soft_max=3.0,
        max=1e3,
        update=renew,
    )
    absorption_colour: FloatVectorProperty(
        name="Colour at Distance",
        description="What is left of white light after the distance inside; white absorbs nothing. Longer ways are darker (Beer's law)",
        default=(1.0, 1.0, 1.0),
        min=0.0,
        max=1.0,
        size=3,
        subtype="COLOR",
        update=renew,
    )
    absorption_distance: FloatProperty(
        name="Distance",
        description="Way inside after which white light has the colour above, in metres: absorption is -ln(colour) / distance",
        default=1.0,
        min=1e-6,
        soft_max=10.0,
        unit="LENGTH",
        update=renew,
    )
    priority: IntProperty(
        name="Priority",
        description=(
            "Where objects that let light in overlap, the inside of the highest priority is there and the others are not; "
            "of equal ones that of the smaller object. A glass of water: give the glass 1, and let the water reach into its wall"
        ),
        default=0,
        soft_min=-10,
        soft_max=10,
        update=renew,
    )
    abbe: FloatProperty(
        name="Abbe Number",
        description=(
            "Dispersion of glass: Abbe number, without a unit; 0 = none. Small numbers spread colours more: "
            "crown glass has 64, water 56, diamond 55, flint glass 30. The index of refraction then is that of yellow light. "
            "Path tracing follows one colour at a time behind such glass, so that there is more noise, and in colours"
        ),
        default=0.0,
        min=0.0,
        soft_max=100.0,
        max=1e6,
        update=renew,
    )


def register():
    bpy.utils.register_class(GlanzMaterialSettings)
    bpy.types.Material.glanz = PointerProperty(type=GlanzMaterialSettings, name="Glanz", description="What Glanz asks of a material")


def unregister():
    del bpy.types.Material.glanz
    bpy.utils.unregister_class(GlanzMaterialSettings)
