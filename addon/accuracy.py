"""*Measure Accuracy*: which settings give the least error in which time, measured in the background, in a panel below Sampling."""

import atexit
import textwrap
import time

import bpy

from . import backend, measurement
from .panels import GlanzPanel
from .preferences import paragraph

_SECONDS_BETWEEN_LOOKS = 0.5
_LETTERS = 90
_state = {"running": None, "outcome": None}
"""A `Measurement`, and the last `Outcome`; they outlive the file that they are about, whose name they tell."""


class GLANZ_OT_measure_accuracy(bpy.types.Operator):
    """Tell which settings give the least error in which time"""

    bl_idname = "glanz.measure_accuracy"
    bl_label = "Measure Accuracy"
    bl_description = (
        "Measure error against time for this scene as it is now, unsaved changes included. Renders a long reference and about "
        "a dozen settings, thrice each, at 256 pixels: takes minutes, in the background. "
        "Writes a table to the folder glanz_bench beside the file, or to a temporary one for a file that was never saved"
    )

    @classmethod
    def poll(cls, context):
        return context.engine == "GLANZ" and backend.engine() is not None and _state["running"] is None

    def execute(self, context):
        if painted := [image.name for image in bpy.data.images if image.is_dirty]:
            self.report({"WARNING"}, f"measured as last saved, as images have unsaved changes: {', '.join(painted)}")
        try:
            running = measurement.start(context.scene, context.view_layer)
        except (OSError, RuntimeError) as error:
            self.report({"ERROR"}, f"Measure Accuracy: {' '.join(str(error).split())}")
            return {"CANCELLED"}
        _state.update(running=running, outcome=None)
        if not bpy.app.background:
            bpy.app.timers.register(_look, first_interval=_SECONDS_BETWEEN_LOOKS, persistent=True)
            return {"FINISHED"}
        # A script has nothing else to do, and timers do not run there.
        while _look() is not None:
            time.sleep(_SECONDS_BETWEEN_LOOKS)
        if _state["outcome"].problem:
            self.report({"ERROR"}, f"Measure Accuracy: {_state['outcome'].problem}")
            return {"CANCELLED"}
        return {"FINISHED"}


class GLANZ_OT_cancel_measurement(bpy.types.Operator):
    """Stop measuring; nothing is written"""

    bl_idname = "glanz.cancel_measurement"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        return _state["running"] is not None

    def execute(self, context):
        _end()
        _redraw()
        return {"FINISHED"}


class GLANZ_RENDER_PT_accuracy(GlanzPanel, bpy.types.Panel):
    bl_label = "Accuracy"
    bl_parent_id = "GLANZ_RENDER_PT_sampling"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        column = self.layout.column()
        running, outcome = _state["running"], _state["outcome"]
        if running:
            column.label(text=running.title, translate=False)
            row = column.row()
            row.progress(factor=running.done, text=f"{running.done:.0%}")
            row.operator("glanz.cancel_measurement", text="", icon="X")
            return
        column.operator("glanz.measure_accuracy")
        if outcome:
            _draw_outcome(self.layout, context, outcome)


def _draw_outcome(layout, context, outcome):
    column = layout.column(align=True)
    column.label(text=outcome.title, translate=False)
    if outcome.problem:
        paragraph(layout, context, outcome.problem)
    rows = [(row.settings, f"{row.seconds:.2f} s", f"{100 * row.error:.2f} %", row.kind) for row in outcome.rows]
    for cells in (("Best settings", "Time", "Error", "Error is"), *rows) if rows else ():
        split = column.split(factor=0.5)
        split.label(text=cells[0], translate=False)
        for cell in cells[1:]:
            split.label(text=cell, translate=False)
    for warning in outcome.warnings:
        paragraph(layout, context, warning, "INFO")
    if outcome.rows:
        paragraph(layout, context, f"All settings: {outcome.folder}", "FILE_FOLDER")


def _look():
    """Seconds until the next look at the running measurement, None where there is none any more."""
    running = _state["running"]
    if running is None:
        return None
    outcome = running.poll()
    if outcome:
        _state.update(running=None, outcome=outcome)
        _tell(outcome)
    _redraw()
    return None if outcome else _SECONDS_BETWEEN_LOOKS


def _tell(outcome):
    """A failure after minutes must not wait until somebody opens the panel."""
    manager = bpy.context.window_manager
    if not outcome.problem or bpy.app.background or not manager.windows:
        return

    def draw(menu, context):
        for line in textwrap.wrap(outcome.problem, _LETTERS):
            menu.layout.label(text=line, translate=False)

    with bpy.context.temp_override(window=manager.windows[0]):
        manager.popup_menu(draw, title="Measure Accuracy", icon="ERROR")


def _redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()


def _end():
    running, _state["running"] = _state["running"], None
    if running:
        running.end()


_CLASSES = (GLANZ_OT_measure_accuracy, GLANZ_OT_cancel_measurement, GLANZ_RENDER_PT_accuracy)


def register():
    for kind in _CLASSES:
        bpy.utils.register_class(kind)
    atexit.register(_end)


def unregister():
    atexit.unregister(_end)
    _end()
    _state["outcome"] = None
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
