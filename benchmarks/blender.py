"""Blender for the measurements: open the Cornell box, set both engines alike, press F12."""

import contextlib
import json
import os
import sys
import time
from pathlib import Path

import bpy
import numpy as np

import glanz

CORNELL_BOX = Path(glanz.__file__).resolve().parent / "sample_scenes" / "cornell_box.blend"
THREADS = 2
OUT = Path("out").resolve()


def open_cornell_box(samples, width=512, height=512):
    """The sample scene, for both engines: equal samples, bounces and threads; Cycles without adaptive sampling or denoising."""
    glanz.register()
    with quiet():
        bpy.ops.wm.open_mainfile(filepath=str(CORNELL_BOX))
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.threads_mode, scene.render.threads = "FIXED", THREADS
    scene.cycles.device = "CPU"
    set_samples(samples)
    # The file has the rest: see sample_scenes/common.py.
    assert scene.cycles.max_bounces == scene.glanz.max_depth
    assert not scene.cycles.use_adaptive_sampling
    return scene


def set_samples(samples):
    scene = bpy.context.scene
    scene.glanz.samples = scene.cycles.samples = samples


def press_f12(engine, **options):
    """(wall, processor) seconds of the operator."""
    bpy.context.scene.render.engine = engine
    wall, cpu = time.perf_counter(), time.process_time()
    with quiet():
        bpy.ops.render.render(**options)
    return time.perf_counter() - wall, time.process_time() - cpu


def picture(engine):
    """(height, width, 4) linear pixels, by F12 and through a file."""
    scene = bpy.context.scene
    image_settings = scene.render.image_settings
    if hasattr(image_settings, "media_type"):
        image_settings.media_type = "IMAGE"
    image_settings.file_format, image_settings.color_depth = "OPEN_EXR", "32"
    path = OUT / "bench_picture.exr"
    scene.render.filepath = str(path)
    press_f12(engine, write_still=True)
    image = bpy.data.images.load(str(path))
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    bpy.data.images.remove(image)
    path.unlink()
    return pixels.reshape(height, width, 4)


@contextlib.contextmanager
def quiet():
    """Keep Blender's own messages, which go past Python, out of stdout."""
    sys.stdout.flush()
    stdout = os.dup(1)
    with open(os.devnull, "wb") as nothing:
        os.dup2(nothing.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(stdout, 1)
        os.close(stdout)


def finish(result):
    """Print the result and leave; without Python's clean-up, which some versions of bpy do not survive."""
    print(json.dumps(result), flush=True)
    os._exit(0)
