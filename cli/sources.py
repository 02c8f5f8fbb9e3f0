"""Where scenes come from: a .blend file, through Blender, or a scene file, without."""

import dataclasses
import os
import sys
from dataclasses import dataclass, field
from pathlib import Path

from ..engine import FileError, SceneError, read_scene
from ..engine.io.png import write_png
from .window import fitted

CURE = "install it with: pip install 'glanz[blender]', on Python 3.11 or 3.13; or use a scene file, written by glanz export elsewhere"
LIBRARIES = "libgl1 libice6 libsm6 libx11-6 libxfixes3 libxi6 libxkbcommon0 libxrender1"
"""What bpy takes from the system, as packages of Debian."""


@dataclass(frozen=True)
class Shot:
    """One picture to make: the engine's values, the frame's number (None: a file without frames), what was approximated.

    notes    {field: value} for each thing that a .blend file's warnings are about
    by_kind  {"missing", "ignored" or "approximated": the warnings that are so}
    is_strict  whether it is an error that something is left out, which may be found later
    """

    scene: object
    settings: object
    frame: int | None
    warnings: tuple = ()
    notes: tuple = ()
    by_kind: dict = field(default_factory=dict)
    is_strict: bool = False


def open_source(path, scene_name, before_blender, view_layer=None):
    """The source for `path`, a .blend file or a scene file; `before_blender` is called before Blender is loaded.

    Raises FileError or SceneError, naming the cause.
    """
    if not os.path.lexists(path):
        raise FileError(f"cannot read '{path}': file not found")
    if Path(path).suffix.lower() == ".blend":
        return _Blend(path, scene_name, before_blender, view_layer)
    if view_layer is not None:
        raise SceneError(f"'{path}' is a scene file, which has no view layers, so none called '{view_layer}'")
    return _SceneFile(path, scene_name)


class _Blend:
    """A .blend file, opened by Blender as a Python module."""

    def __init__(self, path, scene_name, before_blender, view_layer):
        try:
            with open(path, "rb"):
                pass
        except OSError as error:
            raise FileError(f"cannot read '{path}': {error.strerror}") from error
        before_blender()
        try:
            import bpy  # noqa: F401 - asks whether there is one
        except ModuleNotFoundError as error:
            raise FileError(f"cannot read '{path}': .blend files need Blender's Python module bpy ({error}); {CURE}") from error
        except ImportError as error:
            cure = f"on Debian or Ubuntu: sudo apt-get install {LIBRARIES}"
            raise FileError(f"cannot read '{path}': Blender's Python module bpy does not load ({error}); {cure}") from error
        from ..addon import capture

        self._capture = capture
        self._scene_name, self._view_layer = scene_name, view_layer
        capture.open_blend(path)

    def shot(self, frame=None, size=None, strict=None):
        """The `Shot` of a frame, None: the current one; `size` (width, height) replaces the file's resolution.

        `strict`: whether it is an error that something is left out or missing, None: as the file says.
        """
        overrides = {"width": size[0], "height": size[1]} if size else {}
        findings = self._capture.Findings()
        scene, settings, warnings = self._capture.capture(
            frame, self._scene_name, self._view_layer, overrides, strict=strict, findings=findings
        )
        notes = tuple(note.as_dict() for note in findings.notes)
        by_kind = {kind: findings.lines((kind,)) for kind in self._capture.KINDS}
        frame = self._current_frame() if frame is None else frame
        return Shot(scene, settings, frame, warnings, notes, by_kind, findings.is_strict)

    def save_png(self, image, path):
        """Write `image` through the scene's own view transform."""
        self._capture.save_png(image, path, self._scene_name)

    def _current_frame(self):
        import bpy

        return (bpy.data.scenes[self._scene_name] if self._scene_name else bpy.context.scene).frame_current


class _SceneFile:
    """A scene file: one frame, read without Blender."""

    def __init__(self, path, scene_name):
        self._path = path
        self._scene, self._settings = read_scene(path)
        if scene_name not in (None, self._scene.name):
            raise SceneError(f"'{path}' has no scene '{scene_name}'; it holds: {self._scene.name}")

    def shot(self, frame=None, size=None, strict=None):
        """The one `Shot`; `size` (width, height) replaces its resolution, and the longer side keeps its field of view."""
        if frame is not None:
            raise SceneError(f"'{self._path}' is a scene file, which holds one frame without a number")
        if not size:
            return Shot(self._scene, self._settings, None, is_strict=bool(strict))
        old = self._settings
        border = tuple(
            round(edge * new / whole) for edge, new, whole in zip(old.border, size * 2, (old.width, old.height) * 2, strict=False)
        )
        settings = dataclasses.replace(old, width=size[0], height=size[1], border=border)
        return Shot(fitted(self._scene, (old.width, old.height), size), settings, None, is_strict=bool(strict))

    def save_png(self, image, path):
        """Write `image` in plain sRGB."""
        write_png(path, image)


def is_blender_fragile():
    """Whether the loaded Blender, if any, may crash (4.2) or hang (4.5) when Python ends."""
    bpy = sys.modules.get("bpy")
    return bpy is not None and bpy.app.version < (5, 0, 0)
