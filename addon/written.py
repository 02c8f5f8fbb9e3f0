"""Files that Blender has written of a render: it says "Saved" of PNG and EXR files that a full disk has cut off.

Such a file must not pass for a picture, nor be taken for one that needs no rendering any more: it is given another name, and it
is said.
"""

import logging
import os
import struct
import tempfile
from pathlib import Path

import bpy

from . import command_line

CUT_OFF = ".cut_off"
"""What is put behind the name of a file that is not whole."""
log = logging.getLogger("glanz")
_before = {}
_PNG_END = b"IEND\xaeB`\x82"
_EXR_START = b"\x76\x2f\x31\x01"
_EXR_TILED, _EXR_PARTS = 0x200, 0x1000


def is_whole(path):
    """Whether a PNG or EXR file is as long as it says; True for others, which Blender watches itself."""
    with open(path, "rb") as file:
        if file.seek(0, os.SEEK_END) == 0:
            return False
        if Path(path).suffix.lower() == ".png":
            file.seek(-min(file.tell(), len(_PNG_END)), os.SEEK_END)
            return file.read() == _PNG_END
        if Path(path).suffix.lower() != ".exr":
            return True
        try:
            file.seek(0)
            return _is_whole_exr(file, os.path.getsize(path))
        except (struct.error, EOFError):
            return False


def _is_whole_exr(file, size):
    """Whether the chunk that comes last is there (OpenEXR documentation, *File Layout*); not looked at in tiled files."""
    if file.read(4) != _EXR_START:
        return False
    (version,) = struct.unpack("<I", file.read(4))
    has_parts = bool(version & _EXR_PARTS)
    while _skip_header(file) and has_parts:
        continue
    if version & _EXR_TILED:
        return True
    # The table of the places of chunks, which is written last and is as long as there is no chunk.
    start, places = file.tell(), []
    while not places or start + 8 * len(places) < min(places):
        places += struct.unpack("<Q", file.read(8))
        if not places[-1]:
            return False
    last = max(places) + 4 * has_parts
    file.seek(last)
    _, length = struct.unpack("<iI", file.read(8))
    return last + 8 + length <= size


def _skip_header(file):
    """Read to the end of a header; False where it was the empty one behind the headers of all parts."""
    is_empty = True
    while _read_name(file):
        is_empty = False
        _read_name(file)
        (length,) = struct.unpack("<I", file.read(4))
        file.seek(length, os.SEEK_CUR)
    return not is_empty


def _read_name(file):
    name = b""
    while (letter := file.read(1)) != b"\0":
        if not letter:
            raise EOFError
        name += letter
    return name


def paths_of(scene):
    """Where Blender may just have written a picture of `scene`: by its path, or with the number of the frame in it; of each eye.

    Raises RuntimeError for a path that Blender does not understand.
    """
    render, frame = scene.render, scene.frame_current
    numbered = _frame_path(scene)
    still = bpy.path.abspath(render.filepath)
    if render.use_file_extension and not still.lower().endswith(render.file_extension):
        still += render.file_extension
    # Blender fills in templates for frames alone.
    filled = numbered.with_name(numbered.stem.removesuffix(f"{frame:04}") + numbered.suffix)
    paths = [path for path in (numbered, filled, Path(still)) if path.name]
    eyes = [view.file_suffix for view in render.views if view.use] if render.use_multiview else []
    return dict.fromkeys((*paths, *(path.with_name(f"{path.stem}{eye}{path.suffix}") for path in paths for eye in eyes)))


def _frame_path(scene):
    return Path(scene.render.frame_path(frame=scene.frame_current))


def refuse_unwritable(engine, scene, show):
    """Tell before the work what would be told after it: that the picture of `scene` cannot be saved where it should be.

    Raises SceneError for an animation, whose frames are all saved; a still is said to `show`, a function of lines, in the background,
    where it most likely is, and elsewhere not at all.
    """
    from ..engine import SceneError

    if scene.render.is_movie_format or not (engine.is_animation or bpy.app.background):
        return
    try:
        path = _frame_path(scene)
        obstacle = _obstacle(path)
    except RuntimeError as error:
        path, obstacle = scene.render.filepath, " ".join(str(error).removeprefix("Error: ").split())
    if obstacle:
        message = f"scene '{scene.name}': its picture cannot be saved as '{path}': {obstacle}; choose another output path"
        if engine.is_animation:
            raise SceneError(message)
        show((message,))


def _obstacle(path):
    """Why no file can be made at `path`, empty if one can; Blender makes the folders that are missing."""
    if path.is_dir():
        return "it is a folder"
    folder = next(folder for folder in path.absolute().parents if folder.exists())
    try:
        with tempfile.TemporaryFile(dir=folder):
            return ""
    except OSError as error:
        return f"'{folder}' is not to be written to ({error.strerror or error})"


@bpy.app.handlers.persistent
def look(scene, _=None):
    """Remember the files that are there before a picture is rendered; called by Blender."""
    _before.clear()
    _before.update(_files(scene))


@bpy.app.handlers.persistent
def check(scene, _=None):
    """Give files that were cut off another name, and say so; called by Blender when it has written a picture."""
    for path, state in _files(scene).items():
        if state != _before.get(path) and not is_whole(path):
            other = path.with_name(path.name + CUT_OFF)
            os.replace(path, other)
            message = f"the picture '{path}' was cut off when it was saved, is the disk full? What there is of it is called '{other.name}'"
            log.error(message)
            command_line.end_after_failure(message)


def _files(scene):
    """{path: what changes when it is written} of what there is where a picture of `scene` belongs."""
    if scene.render.engine != "GLANZ" or scene.render.is_movie_format:
        return {}
    try:
        paths = [path for path in paths_of(scene) if path.is_file()]
    except RuntimeError:
        # Nothing can be written there, and Blender says so.
        return {}
    return {path: (path.stat().st_mtime_ns, path.stat().st_size) for path in paths}


def register():
    bpy.app.handlers.render_pre.append(look)
    bpy.app.handlers.render_write.append(check)


def unregister():
    bpy.app.handlers.render_write.remove(check)
    bpy.app.handlers.render_pre.remove(look)
