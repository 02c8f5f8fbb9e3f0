"""Material Preview is there while Glanz is the engine: Blender draws it with EEVEE, from the same nodes."""

import bpy
import harness as ui


def main():
    ui.open_file("cornell_box")
    view = ui.area("VIEW_3D")
    with ui.context("VIEW_3D"):
        bpy.ops.view3d.view_camera()
    ui.redraw()
    ui.shot("solid")
    assert not is_lit(view)
    ui.shading("MATERIAL")
    try:
        # Blender compiles EEVEE's shaders first; without a graphics card that takes a minute.
        yield lambda: is_lit(view), 120
    finally:
        ui.shot("material")
    assert view.spaces.active.shading.type == "MATERIAL"


def is_lit(view):
    """Whether the light of the studio is there, as it is not in Solid, and the wall on the left is red, as its nodes say."""
    image = colours(view).astype(int)
    return (image.min(axis=2) > 220).mean() > 0.002 and (image[:, :200, 0] > 1.5 * image[:, :200, 1]).mean() > 0.05


def colours(view):
    """The middle of the viewport, 600 by 600 pixels."""
    height = ui.window().height
    x, y = view.x + view.width // 2, height - view.y - view.height // 2
    return ui.pixels()[y - 300 : y + 300, x - 300 : x + 300]
