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
    show_previews()
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


def show_previews():
    """Register all panels again: the previews first and open, all others closed."""
    found = sorted(panels.properties_panels(), key=lambda panel: not panel.__name__.endswith("_PT_preview"))
    by_name = {getattr(panel, "bl_idname", panel.__name__): panel for panel in found}

    def depth(panel):
        parent = by_name.get(getattr(panel, "bl_parent_id", ""))
        return 1 + depth(parent) if parent else 0

    found.sort(key=depth)
    for panel in reversed(found):
        bpy.utils.unregister_class(panel)
    for panel in found:
        is_preview = panel.__name__.endswith("_PT_preview")
        panel.bl_options = set(getattr(panel, "bl_options", ())) - {"DEFAULT_CLOSED"} | (set() if is_preview else {"DEFAULT_CLOSED"})
        bpy.utils.register_class(panel)
