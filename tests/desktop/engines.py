"""Engines are switched back and forth, the add-on is disabled and enabled, also with its pictures and panels in sight."""

import addon_utils
import bpy
import harness as ui


def main():
    ui.open_file("cornell_box")
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 48
    scene.glanz.samples = 4
    ui.area("PROPERTIES").spaces.active.context = "RENDER"
    first = yield from picture()
    for engine in ("CYCLES", "GLANZ", "BLENDER_WORKBENCH", "GLANZ"):
        scene.render.engine = engine
        ui.redraw()
        yield 0.1
    assert ((yield from picture()) == first).all()
    yield from switched_off_and_on()
    assert scene.render.engine == "GLANZ"
    assert scene.glanz.samples == 4
    assert ((yield from picture()) == first).all()
    yield from preferences()


def picture():
    """The Render Result of F12."""
    render = ui.start_render()
    yield lambda: render.done, 60
    assert render.finished
    return ui.saved_result()


def switched_off_and_on():
    """Twice, with a panel of Glanz in sight; what the file stores of Glanz survives."""
    for _ in range(2):
        bpy.ops.preferences.addon_disable(module=ui.package)
        ui.redraw()
        yield 0.1
        assert not hasattr(bpy.types, "GLANZ_RENDER_PT_sampling")
        assert not hasattr(bpy.types.Scene, "glanz")
        left = [panel for panel in bpy.types.Panel.__subclasses__() if "GLANZ" in getattr(panel, "COMPAT_ENGINES", ())]
        assert not [panel for panel in left if panel.is_registered]
        bpy.ops.preferences.addon_enable(module=ui.package)
        ui.redraw()
        yield 0.1
        assert addon_utils.check(ui.package) == (True, True)


def preferences():
    """Glanz among the extensions, with what it says of itself."""
    ui.show_preferences()
    yield 0.2
    ui.shot("preferences")
