"""Previews of materials, lights and worlds are rendered by Glanz, in their tabs and as icons."""

import bpy
import harness as ui
import panels

RED = (0.9, 0.02, 0.02)


def main():
    bpy.ops.wm.read_homefile(use_factory_startup=True, load_ui=True)
    bpy.context.scene.render.engine = "GLANZ"
    cube, light, world = bpy.data.objects["Cube"], bpy.data.objects["Light"], bpy.context.scene.world
    for datablock, kind, name in ((cube.active_material, "BSDF_PRINCIPLED", "Base Color"), (world, "BACKGROUND", "Color")):
        next(node for node in datablock.node_tree.nodes if node.type == kind).inputs[name].default_value = (*RED, 1)
    light.data.color = RED
    # They are the first and open, so that they are in sight.
    panels.register_again(sorted(panels.properties_panels(), key=is_preview, reverse=True), is_preview)
    yield 0.2
    editor = ui.area()
    editor.type = "PROPERTIES"
    for ob, context in ((cube, "MATERIAL"), (light, "DATA"), (cube, "WORLD")):
        bpy.context.view_layer.objects.active = ob
        ui.redraw()
        editor.spaces.active.context = context
        ui.redraw()
        try:
            yield lambda: red(editor) > 0.005, 60
            yield lambda: not bpy.app.is_job_running("RENDER_PREVIEW"), 60
            ui.redraw()
        finally:
            ui.shot(context.lower())
        print(f"measured: {red(editor):.1%} of the editor {context} is red")


def red(editor):
    """The share of an area that is red."""
    top = ui.window().height - editor.y - editor.height
    image = ui.pixels()[top : top + editor.height, editor.x : editor.x + editor.width].astype(int)
    return ((image[..., 0] > 60) & (image[..., 0] > 1.5 * image[..., 1:].max(axis=2))).mean()


def is_preview(panel):
    return panel.__name__.endswith("_PT_preview")
