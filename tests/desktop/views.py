"""What the scripts about rendered 3D views share: a scene that glows in plain colours, and looks at the screen.

Pictures of the screen are judged by colours that only the render can show, without overlays.
"""

import importlib
import math

import bpy
import harness as ui
import numpy as np
from mathutils import Euler

SOON = 60
"""Seconds that a picture gets to be complete; on an idle machine it takes one."""
RED, GREEN, GREY = (1.0, 0.05, 0.05), (0.05, 1.0, 0.05), (0.5, 0.5, 0.5)


def run(*checks):
    """The steps of a script that makes these `checks`, generator functions, one after the other."""
    start()
    ui.shading("RENDERED")
    yield complete, SOON
    yield 0.5
    assert share(RED) > 0.02
    assert share(GREY) > 0.2
    for check in checks:
        print(f"--- {check.__name__}", flush=True)
        yield from check()


def start():
    """A glowing cube on a grey glowing floor, seen from above; views without anything but the render."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True, load_ui=False)
    scene = bpy.context.scene
    scene.render.engine = "GLANZ"
    scene.view_settings.view_transform = "Standard"
    scene.glanz.viewport_samples = 4
    scene.render.preview_pixel_size = "2"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 200, 100, 100
    scene.glanz.samples = 4
    with ui.context("VIEW_3D"):
        bpy.ops.mesh.primitive_plane_add(size=12)
        named("Floor", glowing("Grey", GREY))
        bpy.ops.mesh.primitive_cube_add(size=2, location=(0, 0, 1))
        named("Cube", glowing("Red", RED))
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler = (7, -7, 6), (math.radians(62), 0, math.radians(45))
    camera.data.show_passepartout = False
    scene.collection.objects.link(camera)
    scene.camera = camera
    for area in ui.window().screen.areas:
        if area.type == "VIEW_3D":
            bare(area)
    free_view()


def named(name, worn):
    """Name what was added last, and let it wear a material."""
    added = bpy.context.view_layer.objects.active
    added.name = name
    added.data.materials.append(worn)


def glowing(name, colour):
    made = bpy.data.materials.new(name)
    if made.node_tree is None:
        made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader = tree.nodes.new("ShaderNodeEmission")
    shader.inputs["Color"].default_value = (*colour, 1)
    tree.links.new(shader.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def bare(area):
    space = area.spaces.active
    space.overlay.show_overlays = space.show_gizmo = False


def free_view(perspective="PERSP"):
    region = space().region_3d
    region.view_perspective = perspective
    region.view_location, region.view_distance = (0, 0, 0.5), 12
    region.view_rotation = Euler((math.radians(55), 0, math.radians(30))).to_quaternion()


def space():
    return ui.area("VIEW_3D").spaces.active


def addon(name):
    return importlib.import_module(f"{ui.package}.addon.{name}")


def sessions():
    return [viewport._session for viewport in addon("viewport_draw")._viewports if not viewport.is_closed]


def complete():
    """Whether all 3D views have all they asked for, and have drawn it."""
    viewports = [viewport for viewport in addon("viewport_draw")._viewports if not viewport.is_closed]
    return bool(viewports) and all(
        not v._session.is_busy and v._session.picture is not None and v._drawn is v._session.picture for v in viewports
    )


def picture():
    """The largest 3D view on the screen, (height, width, 3) in [0, 1], row 0 at the top, without margins, where text and tools are."""
    area, height = ui.area("VIEW_3D"), ui.window().height
    image = ui.pixels()[height - area.y - area.height : height - area.y, area.x : area.x + area.width]
    return image[130:-30, 80:-30] / 255


def display(colour):
    """sRGB, IEC 61966-2-1: the view transform Standard."""
    c = np.array(colour)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def share(colour):
    """Of the pixels of the view that show it."""
    return (np.abs(picture() - display(colour)).max(axis=2) < 0.02).mean()


def window_region():
    return next(region for region in ui.area("VIEW_3D").regions if region.type == "WINDOW")
