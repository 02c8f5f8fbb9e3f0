"""How to tell whether an image is as it was without a look at its pixels: Blender does not say when they are painted, packed or saved."""

import hashlib
import os

import bpy

from .images import paths_of

_OF_FILES = ("FILE", "SEQUENCE", "MOVIE", "TILED", "GENERATED")
"""Sources of images that change when files or settings do, or when they are painted."""
_SETTINGS = (
    "source",
    "alpha_mode",
    "use_deinterlace",
    "use_half_precision",
    "generated_type",
    "generated_width",
    "generated_height",
    "use_generated_float",
)


def no_stamp(image, frame=None):
    """Nothing: Blender is believed."""
    return ()


def stamp_of(image, frame=None):
    """What the pixels of an image datablock come of, to be compared; None where that cannot be said, as they were painted.

    frame  the number of the picture in a sequence or movie
    """
    image = image.original
    if image.is_dirty or image.source not in _OF_FILES:
        return None
    settings = tuple(getattr(image, name) for name in _SETTINGS)
    colours = image.colorspace_settings.name, tuple(image.generated_color), getattr(_working_space(), "working_space", "")
    packed = tuple((file.filepath, _digest(file.packed_file.data)) for file in image.packed_files)
    return settings, colours, packed, tuple((path, _time_of(path)) for path in paths_of(image, frame))


def _working_space():
    # From Blender 5.0 on.
    return getattr(bpy.data, "colorspace", None)


def _digest(content):
    return hashlib.blake2b(content, digest_size=16).digest()


def _time_of(path):
    """When a file was changed, and its size; None where there is none."""
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size
