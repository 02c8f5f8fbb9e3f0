"""Files that keep what F12 has rendered so far: one for each frame, view layer and eye, beside the path that the user names."""

from pathlib import Path

import bpy


def path_of(scene, layer, view=""):
    """Where the checkpoint of a view layer and an eye of the current frame of `scene` is; None where there are to be none."""
    if not scene.glanz.checkpoint:
        return None
    path = Path(bpy.path.abspath(scene.glanz.checkpoint))
    names = (f"{scene.frame_current:04}", bpy.path.clean_name(layer), *((bpy.path.clean_name(view),) if view else ()))
    return path.with_name(f"{path.stem or scene.name}_{'_'.join(names)}{path.suffix or '.checkpoint'}")


def checkpoint_of(scene, layer, view, exported, settings, warn):
    """The engine's checkpoint for an `exported` scene; `warn` is told, as a line, of one that is of another render and is replaced.

    Raises FileError where it cannot be written.
    """
    from ..engine import NO_CHECKPOINT, Checkpoint

    path = path_of(scene, layer, view)
    if path is None:
        return NO_CHECKPOINT

    def on_other(error):
        warn(f"the checkpoint '{path.name}' is of another scene or other settings, or damaged, and is replaced ({error})")

    return Checkpoint(path, exported, settings, scene.glanz.checkpoint_seconds, on_other)
