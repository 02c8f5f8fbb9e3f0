"""A zip that is dropped into the window of a Blender in which Glanz is in use takes its place: as users update it by hand.

Blender's own operator of a drop is called, which asks in a dialog; no mouse drags a file.
"""

import os
import sys

import bpy
import harness as ui


def main():
    ui.open_file("cornell_box")
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 32
    bpy.context.scene.glanz.samples = 1
    first = yield from picture()
    before = sys.modules[ui.package]
    ui.move()
    with ui.context("IMAGE_EDITOR"):
        assert bpy.ops.extensions.package_install_files("INVOKE_DEFAULT", url=os.environ["GLANZ_ZIP"]) == {"RUNNING_MODAL"}
    yield 1.0
    ui.shot("dialog")
    ui.press("RETURN")
    yield lambda: sys.modules.get(ui.package, before) is not before and ui.package in bpy.context.preferences.addons, 60
    yield 1.0
    assert bpy.context.scene.render.engine == "GLANZ"
    assert ((yield from picture()) == first).all()
    ui.shot("after")


def picture():
    render = ui.start_render()
    yield lambda: render.done, 60
    assert render.finished and not render.cancelled
    yield 0.3
    return ui.saved_result()
