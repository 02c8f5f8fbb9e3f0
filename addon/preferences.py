"""What Blender's preferences show below the name of the add-on: whether it can render, and if not, why."""

import textwrap

import bpy

from . import backend, neighbour


class GlanzPreferences(bpy.types.AddonPreferences):
    """Nothing to choose; but here people look when something does not work."""

    bl_idname = __package__.rpartition(".")[0]

    def draw(self, context):
        told = [text for text in (neighbour.complaint(), backend.problem(), backend.remark()) if text]
        for text in told:
            paragraph(self.layout, context, text)
        if not told:
            self.layout.label(text="Ready: choose Glanz in Render Properties > Render Engine", icon="CHECKMARK")


def paragraph(layout, context, text, icon="ERROR"):
    """Write `text` over as many lines as the region needs: labels are cut off where it ends. An error is one that nobody should miss."""
    column = layout.column(align=True)
    column.alert = icon == "ERROR"
    # Letters are about 7 px wide; without a screen the scale is 0.
    letters = int(context.region.width / (7 * (context.preferences.system.ui_scale or 1)))
    for number, line in enumerate(textwrap.wrap(text, max(letters - 8, 20))):
        column.label(text=line, icon="BLANK1" if number else icon, translate=False)


register, unregister = bpy.utils.register_classes_factory((GlanzPreferences,))
