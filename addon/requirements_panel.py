"""What the scene asks for, and what of it is not rendered as in Blender: a panel of the Render properties."""

import bpy

from .panels import GlanzPanel


class GLANZ_RENDER_PT_requirements(GlanzPanel, bpy.types.Panel):
    bl_label = "Scene Requirements"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        column = self.column()
        column.prop(context.scene.glanz, "strict")


_CLASSES = (GLANZ_RENDER_PT_requirements,)


def register():
    for panel in _CLASSES:
        bpy.utils.register_class(panel)


def unregister():
    for panel in reversed(_CLASSES):
        bpy.utils.unregister_class(panel)
