"""Rendered 3D views show things where Blender has them and as F12 has them, follow who looks, and rest."""

import threading
import time

import bpy
import harness as ui
import numpy as np
import views
from mathutils import Quaternion
from views import GREY, RED, SOON, addon, complete, free_view, picture, share, space, window_region


def main():
    yield from views.run(projections, colours, orbit, errors, rest)


def projections():
    """Where the engine's cameras have points is where Blender's own matrix has them, to a tenth of a pixel, in all kinds of views."""
    view_of, camera = addon("viewport_camera").view_of, bpy.context.scene.camera
    free_view()
    yield 0.2
    for name, change in {
        "perspective": free_view,
        "parallel": lambda: free_view("ORTHO"),
        "camera": lambda: free_view("CAMERA"),
        "zoomed": zoom,
        "shifted": lambda: setattr(camera.data, "shift_x", 0.3),
        "upright": lambda: setattr(bpy.context.scene.render, "resolution_y", 300),
        "parallel camera": lambda: setattr(camera.data, "type", "ORTHO"),
    }.items():
        change()
        yield 0.3
        region, data = window_region(), space().region_3d
        view = view_of(region, data, space(), bpy.context.evaluated_depsgraph_get())
        engine_camera = view.camera()
        points = np.random.default_rng(1).uniform(-2, 2, (50, 4))
        points[:, 3] = 1
        own = np.array(data.perspective_matrix, float) @ points.T
        own = (0.5 + 0.5 * own[:2] / own[3]) * [[region.width], [region.height]]
        seen = np.linalg.inv(engine_camera.world_from_camera) @ points.T * [[1], [1], [-1], [1]]
        x, y, width, height = view.rectangle
        found = np.array(engine_camera.in_window(seen[:3])) * [[width], [height]] + [[x], [y]]
        error = np.abs(found - own).max()
        print(f"{name}: {error:.4f} px of {region.width}x{region.height}", flush=True)
        assert error < 0.1, name
    camera.data.type, camera.data.shift_x, bpy.context.scene.render.resolution_y = "PERSP", 0, 100
    free_view()
    yield complete, SOON


def zoom():
    space().region_3d.view_camera_zoom, space().region_3d.view_camera_offset = 12.0, (0.1, -0.05)


def colours():
    """What glows as grey as 0.5 is as grey on the screen as in a file that F12 saves, under two view transforms."""
    scene = bpy.context.scene
    ui.shot("rendered")
    free_view("CAMERA")
    for transform in ("Standard", "AgX"):
        scene.view_settings.view_transform = transform
        yield complete, SOON
        yield 0.5
        ui.shot(f"colours_{transform}")
        image = picture()
        shown = np.median(image[image.shape[0] // 2 + 60 :, image.shape[1] // 2 - 60 : image.shape[1] // 2 + 60], axis=(0, 1))
        values = np.array([float(v) for v in saved_median()])
        print(transform, shown.round(3), values.round(3), flush=True)
        assert np.abs(shown - values).max() < 0.02
    scene.view_settings.view_transform = "Standard"
    free_view()
    yield complete, SOON


def saved_median():
    """A grey plane's colour in a PNG file, through the scene's view transform."""
    scene = bpy.context.scene
    image = bpy.data.images.new("Grey", 4, 4, float_buffer=True)
    image.pixels.foreach_set(np.tile(np.float32((*GREY, 1)), 16))
    path = str(ui.out / "grey.png")
    if hasattr(scene.render.image_settings, "media_type"):
        scene.render.image_settings.media_type = "IMAGE"
    scene.render.image_settings.file_format = "PNG"
    image.save_render(path, scene=scene)
    saved = bpy.data.images.load(path)
    values = np.array(saved.pixels[:3])
    bpy.data.images.remove(saved)
    bpy.data.images.remove(image)
    return values


def orbit():
    """While the view turns there are always pixels of the newest views but one or two, and nothing is compiled; each draw is short."""
    viewport = next(v for v in addon("viewport_draw")._viewports if not v.is_closed)
    accel = viewport._session._plan.world.accel
    region, seen, times = space().region_3d, set(), []
    draw = type(viewport).draw

    def timed(self, *args):
        wall, cpu = time.perf_counter(), time.thread_time()
        draw(self, *args)
        times.append((time.perf_counter() - wall, time.thread_time() - cpu))

    type(viewport).draw = timed
    try:
        for _ in range(30):
            region.view_rotation = Quaternion((0, 0, 1), 0.1) @ region.view_rotation
            yield 0.04
            seen.add(id(viewport._session.picture))
        ui.shot("orbit")
        yield complete, SOON
        first = []
        for _ in range(5):
            found = [None]
            watch = threading.Thread(target=first_picture, args=(viewport, found))
            watch.start()
            region.view_rotation = Quaternion((0, 0, 1), 0.1) @ region.view_rotation
            yield lambda watch=watch: not watch.is_alive()
            first.append(found[0])
            yield complete, SOON
    finally:
        type(viewport).draw = draw
    wall, cpu = (sorted(1e3 * t[i] for t in times) for i in (0, 1))
    print(
        f"measured: draw median {wall[len(wall) // 2]:.1f} ms, 95 % {wall[len(wall) * 95 // 100]:.1f} ms, most {wall[-1]:.1f} ms",
        flush=True,
    )
    print(f"measured: draw takes of the processor: median {cpu[len(cpu) // 2]:.1f} ms, most {cpu[-1]:.1f} ms", flush=True)
    print(f"measured: {len(seen)} pictures in {len(wall)} draws", flush=True)
    print(f"measured: first picture after a turn: {[round(1e3 * t) for t in first]} ms", flush=True)
    assert viewport._session._plan.world.accel is accel
    assert len(seen) > 3
    assert share(RED) > 0.02


def first_picture(viewport, found):
    """From the draw that sees another view to the first picture of it, seconds: what Blender's own drawing takes is not counted."""
    session = viewport._session
    view, picture = session._view, session.picture
    while session._view is view:
        time.sleep(0.0005)
    begun = time.perf_counter()
    while session.picture is picture:
        time.sleep(0.0005)
    found[0] = time.perf_counter() - begun


def errors():
    """What cannot be rendered is said in the view, and rendered as soon as it can be."""
    scene = bpy.context.scene
    camera = scene.camera.data
    free_view("CAMERA")
    yield complete, SOON
    owner = camera if hasattr(camera, "panorama_type") else getattr(camera, "cycles", None)
    camera.type = "PANO"
    if hasattr(owner, "panorama_type"):
        owner.panorama_type = "MIRRORBALL"
        yield 1.0
        ui.shot("error")
        told = [v._text[0] for v in addon("viewport_draw")._viewports if not v.is_closed]
        assert any("MIRRORBALL" in text for text in told), told
        owner.panorama_type = "EQUIRECTANGULAR"
        yield 0.3
    yield complete, SOON
    yield 0.3
    ui.shot("panorama")
    camera.type = "PERSP"
    free_view()
    yield 0.3
    yield complete, SOON


def rest():
    """When all samples are there, no thread of Glanz uses the processor."""
    yield complete, SOON
    yield 1.0
    before = dict(busy_threads())
    begun = time.process_time(), time.perf_counter()
    yield 3.0
    used = sum(seconds - before.get(name, 0) for name, seconds in busy_threads())
    whole = (time.process_time() - begun[0]) / (time.perf_counter() - begun[1])
    print(f"measured: at rest Glanz takes {used:.3f} s of the processor in 3 s, all of Blender {100 * whole:.1f} %", flush=True)
    assert used < 0.02


def busy_threads():
    """(native id, seconds of processor) of Glanz's threads, where the system tells."""
    for thread in threading.enumerate():
        if thread.name.startswith("glanz"):
            try:
                with open(f"/proc/self/task/{thread.native_id}/stat", encoding="ascii") as file:
                    fields = file.read().rpartition(")")[2].split()
            except OSError:
                continue
            yield thread.native_id, (int(fields[11]) + int(fields[12])) / 100
