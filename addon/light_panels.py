"""Panels of lights in the Properties editor."""

import bpy

from .panels import GlanzPanel

_SHAPE_OF_LIGHT = {
    "POINT": ("shadow_soft_size", "use_soft_falloff"),
    "SPOT": ("shadow_soft_size", "use_soft_falloff", "spot_size", "spot_blend"),
    "SUN": ("angle",),
    "AREA": ("shape", "size", "size_y", "spread"),
}


class GLANZ_LIGHT_PT_light(GlanzPanel, bpy.types.Panel):
    """Everything about a light that Glanz renders; what this version of Blender lacks is skipped."""

    bl_label = "Light"
    bl_context = "data"
    about = "light"

    def draw(self, context):
        light = context.light
        self.layout.row().prop(light, "type", expand=True)
        column = self.column()
        for name in ("color", "use_temperature", "temperature", "energy", "exposure", "normalize"):
            if hasattr(light, name) and not (name == "temperature" and not light.use_temperature):
                column.prop(light, name)
        column.separator()
        is_cosine = light.type == "SPOT" and light.glanz.characteristic == "COSINE"
        for name in _SHAPE_OF_LIGHT[light.type]:
            if (name == "size_y" and light.shape in ("SQUARE", "DISK")) or (name in ("spot_size", "spot_blend") and is_cosine):
                continue
            column.prop(light, name)
        if light.type == "SPOT":
            column.prop(light.glanz, "characteristic")
            if is_cosine:
                column.prop(light.glanz, "exponent")
        if context.object and context.object.data == light:
            column.separator()
            column.prop(context.object, "visible_camera", text="Visible to Camera")


class GLANZ_LIGHT_PT_nodes(GlanzPanel, bpy.types.Panel):
    """What a light shines through; Blender shows it for Cycles and EEVEE only."""

    bl_label = "Nodes"
    bl_context = "data"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    about = "light"

    def draw(self, context):
        light = context.light
        column = self.column()
        # From Blender 5.2 on all lights have nodes, and to ask is deprecated.
        has_nodes = getattr(light.bl_rna.properties["use_nodes"], "is_deprecated", False) or light.use_nodes
        if light.node_tree is None or not has_nodes:
            column.prop(light, "use_nodes", icon="NODETREE", toggle=True)
            return
        output = light.node_tree.get_output_node("CYCLES")
        if output is None:
            column.label(text="There is no Light Output")
        else:
            self.layout.template_node_view(light.node_tree, output, output.inputs[0])


_CLASSES = (GLANZ_LIGHT_PT_light, GLANZ_LIGHT_PT_nodes)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
