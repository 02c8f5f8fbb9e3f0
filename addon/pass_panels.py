"""Panels of what passes are made of: names and numbers that users give, and mist. The passes themselves are in `panels`."""

import bpy

from .panels import GlanzPanel


class _OfPasses(GlanzPanel):
    bl_context = "view_layer"
    bl_parent_id = "GLANZ_VIEWLAYER_PT_passes"
    bl_options = frozenset({"DEFAULT_CLOSED"})


class GLANZ_VIEWLAYER_PT_cryptomatte(_OfPasses, bpy.types.Panel):
    bl_label = "Cryptomatte"

    def draw(self, context):
        column = self.column()
        for name in ("object", "material", "asset"):
            column.prop(context.view_layer, f"use_pass_cryptomatte_{name}")
        column.prop(context.view_layer, "pass_cryptomatte_depth", text="Levels")


class _NamedPasses(_OfPasses):
    """A list of what users have named."""

    def draw(self, context):
        layer, row = context.view_layer, self.layout.row()
        row.template_list(self.list_type, self.what, layer, f"{self.what}s", layer, f"active_{self.what}_index", rows=3)
        column = row.column(align=True)
        column.operator(f"scene.view_layer_add_{self.what}", icon="ADD", text="")
        column.operator(f"scene.view_layer_remove_{self.what}", icon="REMOVE", text="")


class GLANZ_VIEWLAYER_PT_aovs(_NamedPasses, bpy.types.Panel):
    bl_label = "Shader AOV"
    list_type, what = "VIEWLAYER_UL_aov", "aov"


class GLANZ_VIEWLAYER_PT_light_groups(_NamedPasses, bpy.types.Panel):
    bl_label = "Light Groups"
    list_type, what = "UI_UL_list", "lightgroup"


class _InPasses(GlanzPanel):
    """How a data-block shows up in passes."""

    bl_label = "In Passes"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        column, owner = self.column(), getattr(context, self.about)
        if hasattr(owner, "pass_index"):
            column.prop(owner, "pass_index")
        if hasattr(owner, "lightgroup"):
            column.prop_search(owner, "lightgroup", context.view_layer, "lightgroups", text="Light Group")
        if hasattr(owner, "light_settings"):
            column.prop(owner.light_settings, "distance", text="Occlusion Distance")
        for name in ("start", "depth", "falloff") if hasattr(owner, "mist_settings") else ():
            column.prop(owner.mist_settings, name, text=f"Mist {name.title()}")


class GLANZ_OBJECT_PT_in_passes(_InPasses, bpy.types.Panel):
    bl_context = about = "object"


class GLANZ_MATERIAL_PT_in_passes(_InPasses, bpy.types.Panel):
    bl_context = about = "material"


class GLANZ_WORLD_PT_in_passes(_InPasses, bpy.types.Panel):
    bl_context = about = "world"


_CLASSES = (
    GLANZ_VIEWLAYER_PT_cryptomatte,
    GLANZ_VIEWLAYER_PT_aovs,
    GLANZ_VIEWLAYER_PT_light_groups,
    GLANZ_OBJECT_PT_in_passes,
    GLANZ_MATERIAL_PT_in_passes,
    GLANZ_WORLD_PT_in_passes,
)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
