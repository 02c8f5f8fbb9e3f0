"""F12: tiles are seen as they finish, and the picture stays."""

import bpy
import harness as ui


def main():
    ui.open_file("cornell_box")
    scene = bpy.context.scene
    assert scene.render.engine == "GLANZ"
    scene.render.resolution_x = scene.render.resolution_y = 256
    scene.render.resolution_percentage = 100
    scene.glanz.samples = 32
    scene.glanz.tile_size = 32
    bpy.context.preferences.view.render_display_type = "AREA"
    ui.show_image(bpy.data.images.new("Nothing", 256, 256)).spaces.active.image = None
    ui.redraw()
    yield 0.5
    before = ui.pixels()
    render = ui.watch_render()
    ui.press("F12")
    yield lambda: render.begun
    yield lambda: share(render) >= 50, 60
    assert not render.done
    ui.shot("half")
    half = ui.pixels()
    yield lambda: render.done, 60
    assert render.finished and not render.cancelled
    yield 1.0
    ui.shot("done")
    whole = ui.pixels()
    seen = 1 - (whole != half).mean() / (whole != before).mean()
    print(f"measured: half way {seen:.0%} of the picture was seen")
    assert 0.2 < seen < 0.9
    result = ui.saved_result()
    assert result.shape == (256, 256, 4)
    assert (result[..., 3] == 1).all()
    assert 0.1 < result[..., :3].mean() < 10


def share(render):
    """The last percentage of the status line."""
    lines = [line for line in render.stats if "% of" in line]
    return float(lines[-1].partition("% of")[0].split()[-1].lstrip("|")) if lines else 0.0
