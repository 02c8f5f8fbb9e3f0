"""With a library that cannot be loaded Blender starts, says in preferences and panel what is wrong, and F12 is an error."""

import sys

import bpy
import harness as ui


def main():
    ui.expect("Glanz cannot render: its library embreex")
    bpy.ops.preferences.addon_disable(module=ui.package)
    for name in list(sys.modules):
        if name.startswith(ui.package) or name.partition(".")[0] == "embreex":
            del sys.modules[name]
    sys.modules["embreex"] = None
    bpy.ops.preferences.addon_enable(module=ui.package)
    ui.open_file("cornell_box")
    assert bpy.context.scene.render.engine == "GLANZ"
    ui.area("PROPERTIES").spaces.active.context = "RENDER"
    editor = ui.show_preferences()
    yield 0.3
    ui.shot("told")
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        assert "Glanz cannot render: its library embreex cannot be loaded" in str(error), error
    else:
        raise AssertionError("a render without Embree was no error")
    # What F12 shows to a user: the text in the status bar, once something happens.
    editor.type = "VIEW_3D"
    try:
        render = ui.start_render("NONE")
    except RuntimeError as error:
        # On a fast machine the render has failed before the operator is through, which then says so itself.
        assert "Glanz cannot render: its library embreex cannot be loaded" in str(error), error
    else:
        yield lambda: render.done
        assert render.cancelled
    ui.move()
    yield 0.5
    ui.shot("f12")
