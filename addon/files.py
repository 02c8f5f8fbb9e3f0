"""Files by way of Blender: opening .blend files, and pictures with Blender's view transform."""

import os
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np

from ..engine import FileError, SceneError
from .written import is_whole

# A .blend file is plain, or packed by Zstandard, or, from old versions, by gzip.
_STARTS = (b"BLENDER", b"\x28\xb5\x2f\xfd", b"\x1f\x8b")


def open_blend(path):
    """Open a .blend file without running the scripts in it. Raises FileError naming `path` and the cause."""
    path = Path(path).resolve()
    try:
        with open(path, "rb") as file:
            start = file.read(8)
    except OSError as error:
        raise FileError(f"cannot read {path}: {error.strerror or error}") from None
    if not start.startswith(_STARTS):
        raise FileError(f"{path} is not a .blend file")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise FileError(f"Blender {bpy.app.version_string} cannot open {path}: {' '.join(str(error).split())}") from None
    if Path(bpy.data.filepath).resolve() != path:
        raise FileError(f"Blender {bpy.app.version_string} did not open {path}")


def save_png(image, path, scene_name=None):
    """Write the Combined pass of an engine `Image` as PNG, through the view transform of the open file's scene.

    scene_name  None: the active scene. The file appears whole or not at all. Raises FileError naming `path`,
    SceneError for an unknown scene.
    """
    path = Path(path).resolve()
    scene = bpy.context.scene if scene_name is None else bpy.data.scenes.get(scene_name)
    if scene is None:
        raise SceneError(f"unknown scene '{scene_name}'")
    if not path.parent.is_dir():  # Blender would make one
        raise FileError(f"cannot write {path}: there is no folder {path.parent}")
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.png")
    try:
        with _datablock(image) as datablock, _png_settings(scene.render.image_settings):
            datablock.save_render(str(temporary), scene=scene)
        # Blender does not say when a disk was full.
        if not is_whole(temporary):
            raise FileError(f"cannot write {path}: the file was cut off, is the disk full?")
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except (OSError, RuntimeError) as error:
        raise FileError(f"cannot write {path}: {getattr(error, 'strerror', None) or ' '.join(str(error).split())}") from None
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def _datablock(image):
    """The Combined pass of an engine `Image` as an image of Blender's, removed afterwards."""
    datablock = bpy.data.images.new("Glanz", image.width, image.height, alpha=True, float_buffer=True)
    try:
        datablock.alpha_mode = "PREMUL"
        datablock.pixels.foreach_set(np.ascontiguousarray(image.passes["Combined"][::-1], np.float32).reshape(-1))
        yield datablock
    finally:
        bpy.data.images.remove(datablock)


@contextmanager
def _png_settings(settings):
    """A scene's output settings switched to PNG, and back afterwards."""
    names = [name for name in ("media_type", "file_format", "color_mode", "color_depth") if hasattr(settings, name)]
    before = {name: getattr(settings, name) for name in names}
    try:
        if "media_type" in before:  # Blender 5: decides which formats there are
            settings.media_type = "IMAGE"
        settings.file_format = "PNG"
        yield
    finally:
        for name, value in before.items():
            setattr(settings, name, value)
