"""Rendered 3D views follow what changes: things, materials, modes, regions, and what is undone."""

import bpy
import harness as ui
import numpy as np
import views
from views import GREEN, GREY, RED, SOON, bare, complete, named, picture, sessions, share, space


def main():
    yield from views.run(material, movement, modes, selection, hiding, border, resize, two_views, undo)


def material():
    """A new colour is seen, the tree stays; a new node too."""
    (session,) = sessions()
    accel = session._plan.world.accel
    shader = bpy.data.materials["Red"].node_tree.nodes["Emission"]
    shader.inputs["Color"].default_value = (*GREEN, 1)
    yield lambda: complete() and share(GREEN) > 0.02, SOON
    ui.shot("material")
    assert share(RED) == 0
    assert session._plan.world.accel is accel
    shader.inputs["Color"].default_value = (*RED, 1)
    yield lambda: complete() and share(RED) > 0.02, SOON


def movement():
    """What moves is seen elsewhere, and no mesh is exported again."""
    meshes = {o.name: o.mesh for o in sessions()[0]._scene.objects}
    before = picture()
    bpy.data.objects["Cube"].location.x = 2
    yield 0.3
    yield complete, SOON
    yield 0.3
    assert np.abs(picture() - before).max() > 0.3
    assert meshes == {o.name: o.mesh for o in sessions()[0]._scene.objects}
    bpy.data.objects["Cube"].location.x = 0
    yield 0.3
    yield complete, SOON


def modes():
    """In Edit Mode the mesh is seen as it is being edited."""
    cube = bpy.data.objects["Cube"]
    with ui.context("VIEW_3D"):
        bpy.context.view_layer.objects.active = cube
        bpy.ops.object.mode_set(mode="EDIT")
    yield 0.3
    yield complete, SOON
    yield 0.3
    small = share(RED)
    assert small > 0.02
    with ui.context("VIEW_3D"):
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.transform.resize(value=(2, 2, 2))
    yield lambda: complete() and share(RED) > 2 * small, SOON
    ui.shot("edit_mode")
    with ui.context("VIEW_3D"):
        bpy.ops.transform.resize(value=(0.5, 0.5, 0.5))
        bpy.ops.object.mode_set(mode="OBJECT")
    yield lambda: complete() and share(RED) < 1.2 * small, SOON


def selection():
    """To select is no change."""
    (session,) = sessions()
    shown = session.picture
    bpy.data.objects["Cube"].select_set(False)
    yield 0.5
    bpy.data.objects["Cube"].select_set(True)
    yield 0.5
    assert session.picture is shown


def hiding():
    """What is hidden, or out of a local view, is not seen."""
    cube = bpy.data.objects["Cube"]
    cube.hide_set(True)
    yield lambda: complete() and share(RED) == 0, SOON
    cube.hide_set(False)
    yield lambda: complete() and share(RED) > 0.02, SOON
    grey = share(GREY)
    for one in bpy.data.objects:
        one.select_set(one == cube)
    with ui.context("VIEW_3D"):
        bpy.ops.view3d.localview(frame_selected=False)
    yield lambda: complete() and share(GREY) == 0 and share(RED) > 0.02, SOON
    ui.shot("local_view")
    with ui.context("VIEW_3D"):
        bpy.ops.view3d.localview(frame_selected=False)
    yield lambda: complete() and abs(share(GREY) - grey) < 0.02, SOON


def border():
    """Nothing is rendered beyond a border, and within it the picture is where it was."""
    whole = picture()
    view = space()
    view.render_border_min_x, view.render_border_max_x, view.render_border_min_y, view.render_border_max_y = 0.4, 0.7, 0.2, 0.8
    view.use_render_border = True
    yield 0.3
    yield complete, SOON
    yield 0.3
    ui.shot("border")
    part = picture()
    height, width, _ = whole.shape
    assert share(GREY) < 0.25
    middle = (slice(int(0.4 * height), int(0.6 * height)), slice(int(0.45 * width), int(0.65 * width)))
    assert (np.abs(part[middle] - whole[middle]).max(axis=2) < 0.02).mean() > 0.95
    view.use_render_border = False
    yield 0.3
    yield complete, SOON


def resize():
    """Another size of the region is another picture, with the middle in the middle."""
    area = ui.area("VIEW_3D")
    (session,) = sessions()
    shape = session.picture.pixels.shape
    with bpy.context.temp_override(window=ui.window(), area=area):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.6)
    yield 0.5
    other = min((a for a in ui.window().screen.areas if a.type == "VIEW_3D"), key=lambda a: a.width * a.height)
    other.type = "TEXT_EDITOR"
    yield 0.5
    yield complete, SOON
    yield 0.3
    ui.shot("resized")
    (session,) = sessions()
    assert session.picture.pixels.shape[1] < 0.8 * shape[1]
    assert share(RED) > 0.02
    other.type = "VIEW_3D"
    bare(other)


def two_views():
    """Two views at once, each with its own."""
    areas = sorted((a for a in ui.window().screen.areas if a.type == "VIEW_3D"), key=lambda a: a.width * a.height)
    areas[0].spaces.active.shading.type = "RENDERED"
    areas[0].spaces.active.region_3d.view_distance = 25
    yield 0.5
    yield lambda: len(sessions()) == 2 and complete(), SOON
    yield 0.3
    ui.shot("two_views")
    for one in sessions():
        assert (np.abs(one.picture.pixels[..., :3] - RED).max(axis=2) < 0.02).mean() > 0.001
    areas[0].type = "TEXT_EDITOR"
    yield lambda: len(sessions()) == 1, SOON


def undo():
    """What is undone is seen undone."""
    yield complete, SOON
    red = share(RED)
    with ui.context("VIEW_3D"):
        bpy.ops.ed.undo_push(message="before")
        bpy.data.objects["Cube"].scale = (2, 2, 2)
        bpy.ops.ed.undo_push(message="after")
    yield lambda: complete() and share(RED) > 1.5 * red, SOON
    with ui.context("VIEW_3D"):
        bpy.ops.ed.undo()
    yield lambda: complete() and abs(share(RED) - red) < 0.02, SOON
    with ui.context("VIEW_3D"):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, location=(3, 0, 0.5))
        named("Sphere", bpy.data.materials["Red"])
        bpy.ops.ed.undo_push(message="sphere")
    yield lambda: complete() and share(RED) > 1.05 * red, SOON
    with ui.context("VIEW_3D"):
        bpy.ops.ed.undo()
    yield lambda: complete() and abs(share(RED) - red) < 0.02, SOON
