"""Measure Accuracy in a window: it goes on beside the user, is cancelled, tells what it found or why not, and ends with Blender."""

import importlib
import os
import shutil
import subprocess
import time

import bpy
import harness as ui

accuracy = importlib.import_module(f"{ui.package}.addon.accuracy")
ENDING = f"""
import importlib, bpy
def start():
    bpy.ops.wm.open_mainfile(filepath={str(ui.out / "a.blend")!r}, load_ui=False)
    bpy.context.scene.render.engine = "GLANZ"
    bpy.ops.glanz.measure_accuracy()
    accuracy = importlib.import_module("{ui.package}.addon.accuracy")
    print("pid", accuracy._state["running"]._child.pid, flush=True)
    bpy.app.timers.register(lambda: bpy.ops.wm.quit_blender() and None, first_interval=0.5)
bpy.app.timers.register(start, first_interval=0.5, persistent=True)
"""


def main():
    path = ui.out / "a.blend"
    shutil.copy(ui.ROOT / "sample_scenes" / "cornell_box.blend", path)
    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False)
    scene = bpy.context.scene
    scene.render.engine = "GLANZ"
    scene.render.resolution_x = scene.render.resolution_y = 24
    scene.glanz.max_depth = 1
    panel = accuracy.GLANZ_RENDER_PT_accuracy
    bpy.utils.unregister_class(panel)
    panel.bl_options = set()
    bpy.utils.register_class(panel)
    editor = ui.area()
    editor.type = "PROPERTIES"
    editor.spaces.active.context = "RENDER"
    yield 0.5

    with ui.context("PROPERTIES"):
        bpy.ops.ed.undo_push(message="A change")
        assert bpy.data.is_dirty
        began = time.monotonic()
        assert bpy.ops.glanz.measure_accuracy() == {"FINISHED"}
        print(f"measured: Blender was held up for {time.monotonic() - began:.2f} s")
    assert bpy.data.is_dirty
    assert bpy.data.filepath == str(path)
    child = accuracy._state["running"]._child
    yield 1.0
    ui.shot("running")
    assert bpy.ops.glanz.cancel_measurement() == {"FINISHED"}
    assert child.returncode is not None
    yield 0.5
    ui.shot("cancelled")

    outcome = yield from measured()
    assert not outcome.problem, outcome.problem
    assert outcome.rows
    assert (ui.out / "glanz_bench" / "curve.json").exists()
    ui.shot("best")

    scene.camera = None
    outcome = yield from measured()
    assert "camera" in outcome.problem, outcome
    ui.shot("failed")
    ui.press("ESC")

    told = subprocess.run([bpy.app.binary_path, "--python-expr", ENDING], capture_output=True, text=True, timeout=60)
    pids = [line.split()[1] for line in told.stdout.splitlines() if line.startswith("pid")]
    assert len(pids) == 1, told.stdout + told.stderr
    assert not is_running(int(pids[0])), told.stdout


def measured():
    assert bpy.ops.glanz.measure_accuracy() == {"FINISHED"}
    yield lambda: accuracy._state["outcome"], 100
    yield 0.5
    return accuracy._state["outcome"]


def is_running(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True
