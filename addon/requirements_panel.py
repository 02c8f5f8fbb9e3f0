"""What the scene asks for, and what of it is not rendered as in Blender: panels of the Render properties."""

import json

import bpy

from .checks import check_of
from .panels import GlanzPanel

_MOST_ROWS = 40
_MOST_NAMES = 3
_ICONS = {"missing": "ERROR", "ignored": "CANCEL", "approximated": "INFO"}


class _OfCheck(GlanzPanel):
    """Shared by the panels that show the `Check` of the view layer."""

    bl_parent_id = "GLANZ_RENDER_PT_requirements"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and check_of(context.scene, context.view_layer.name) is not None


class GLANZ_RENDER_PT_requirements(GlanzPanel, bpy.types.Panel):
    bl_label = "Scene Requirements"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        column = self.column()
        column.prop(context.scene.glanz, "strict")
        column.operator("glanz.check_scene")
        check = check_of(context.scene, context.view_layer.name)
        column.label(text=summary(check) if check else "Neither rendered nor checked yet")


class GLANZ_RENDER_PT_differences(_OfCheck, bpy.types.Panel):
    bl_label = "Not as in Blender"

    def draw(self, context):
        column = self.layout.column()
        groups = {}
        for note in check_of(context.scene, context.view_layer.name).notes:
            groups.setdefault((note.kind, note.what), []).append(note)
        rows = 0
        for kind, what in sorted(groups, key=lambda group: list(_ICONS).index(group[0])):
            column.label(text=f"{kind.capitalize()}: {what}", icon=_ICONS[kind], translate=False)
            for note in groups[kind, what]:
                rows += 1
                if note.owner and rows <= _MOST_ROWS:
                    _draw_place(column, note)
        if rows > _MOST_ROWS:
            column.label(text=f"and {rows - _MOST_ROWS} more")
        if not groups:
            column.label(text="Everything is rendered as in Blender", icon="CHECKMARK")


class GLANZ_RENDER_PT_features(_OfCheck, bpy.types.Panel):
    bl_label = "Features in Use"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        column = self.layout.column()
        for feature, names in check_of(context.scene, context.view_layer.name).features.items():
            split = column.split(factor=0.6)
            split.label(text=feature, translate=False)
            rest = len(names) - _MOST_NAMES
            split.label(text=", ".join(names[:_MOST_NAMES]) + (f" and {rest} more" if rest > 0 else ""), translate=False)


def _draw_place(column, note):
    """Who is concerned, with a button that shows it where there is something to select."""
    row = column.row()
    row.label(text=note.place, icon="BLANK1", translate=False)
    kind, name = note.datablock
    if kind in ("object", "light", "mesh", "material", "camera") or note.node:
        button = row.operator("glanz.show", text="", icon="NODE" if note.node else "RESTRICT_SELECT_OFF")
        button.datablock, button.name, button.node = kind, name, json.dumps(note.node)


def summary(check):
    """Such as "Rendered at frame 1: 2 ignored, 1 approximated"; each thing that happened counts once."""
    happened = {(note.kind, note.what) for note in check.notes}
    counts = [f"{count} {kind}" for kind in _ICONS if (count := sum(kind == k for k, _ in happened))]
    return f"{check.origin}: {', '.join(counts) or 'exact'}"


_CLASSES = (GLANZ_RENDER_PT_requirements, GLANZ_RENDER_PT_differences, GLANZ_RENDER_PT_features)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
