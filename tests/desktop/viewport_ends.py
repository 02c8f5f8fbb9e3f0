"""Whatever ends a rendered 3D view while it is at work: nothing of it is left."""

import threading

import bpy
import harness as ui
import views
from views import SOON, sessions, space


def main():
    yield from views.run(endings)


def endings():
    """While views are being rendered: other shading, a file that is loaded, and Glanz switched off, leave no thread behind."""
    scene = bpy.context.scene
    for name, end, again in (
        ("shading", lambda: ui.shading("SOLID"), lambda: ui.shading("RENDERED")),
        ("engine", lambda: setattr(scene.render, "engine", "BLENDER_WORKBENCH"), lambda: setattr(scene.render, "engine", "GLANZ")),
        ("file", load, views.start),
    ):
        yield from begin()
        end()
        yield lambda: not any(thread.name.startswith("glanz") for thread in threading.enumerate()), SOON
        print(f"ended by {name}", flush=True)
        again()
        ui.shading("RENDERED")
        yield 1.0
    yield from begin()
    bpy.ops.preferences.addon_disable(module=ui.package)
    yield lambda: not any(thread.name.startswith("glanz") for thread in threading.enumerate()), SOON
    print("ended by switching Glanz off", flush=True)
    bpy.ops.preferences.addon_enable(module=ui.package)
    bpy.context.scene.render.engine = "GLANZ"
    ui.shading("RENDERED")
    # Blender now ends in the midst of it.
    yield from begin()


def begin():
    """Let the view be at work, without an end."""
    bpy.context.scene.glanz.viewport_samples = 0
    yield 0.5
    space().region_3d.view_distance += 1
    yield lambda: bool(sessions()) and sessions()[0].status.startswith("Sample"), SOON


def load():
    bpy.ops.wm.read_homefile(use_factory_startup=True, load_ui=False)
