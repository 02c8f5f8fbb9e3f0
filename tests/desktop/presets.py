"""Presets in the header of the Sampling panel: Glanz's own are offered; users add, choose and remove theirs, and undo it."""

import shutil
from pathlib import Path

import bpy
import harness as ui


def main():
    bpy.ops.wm.read_homefile(use_factory_startup=True, load_ui=True)
    glanz = bpy.context.scene.glanz
    bpy.context.scene.render.engine = "GLANZ"
    editor = ui.area()
    editor.type = "PROPERTIES"
    editor.spaces.active.context = "RENDER"
    yield from shown("none_yet")

    add = bpy.ops.glanz.sampling_preset_add
    glanz.samples = 77
    for name in ("Größer", "夜"):
        assert add(name=name) == {"FINISHED"}
    folder = Path(bpy.utils.user_resource("SCRIPTS", path="presets/glanz"))
    files = sorted(folder.iterdir())
    assert len(files) == 2, files
    yield from shown("two")

    with ui.context("PROPERTIES"):
        bpy.ops.glanz.sampling_preset("EXEC_DEFAULT", True, preset="FINAL")
        bpy.ops.script.execute_preset(filepath=str(files[0]), menu_idname="GLANZ_PT_sampling_presets")
        assert bpy.context.scene.glanz.samples == 77
        bpy.ops.ed.undo()
        assert bpy.context.scene.glanz.samples == 1024, bpy.context.scene.glanz.samples
        bpy.ops.ed.redo()
        assert bpy.context.scene.glanz.samples == 77
    for name in ("Größer", "夜"):
        assert add(name=name, remove_name=True) == {"FINISHED"}
    # Blender leaves compiled ones.
    assert not list(folder.glob("*.py"))
    shutil.rmtree(folder)


def shown(name):
    """A picture of the panel, which opens where the mouse is."""
    ui.move()
    with ui.context("PROPERTIES"):
        bpy.ops.wm.call_panel(name="GLANZ_PT_sampling_presets")
    yield 1.0
    ui.shot(name)
    ui.press("ESC")
    yield 0.3
