"""Blender's images as arrays of numbers."""

import re

import bpy
import numpy as np

from .findings import MISSING
from .image_files import pixels_in, pixels_of_data, pixels_of_file, scene_linear

MAGENTA = (1.0, 0.0, 1.0, 1.0)
"""Magenta: what Blender shows for an image that it cannot find."""
_PLAIN = ("Linear Rec.709", "Working Space")
"""Colour spaces in which numbers are scene-linear as they are."""


def frame_shown(user, frame):
    """The number of the picture that an ImageUser shows of a sequence or movie at a `frame` of the scene.

    As Cycles counts: `use_auto_refresh` is for the viewport.
    """
    length, frame = user.frame_duration, frame - user.frame_start + 1
    if length <= 0:
        return 0
    return user.frame_offset + ((frame - 1) % length + 1 if user.use_cyclic else min(max(frame, 0), length))


def texels_of(image, frame=None, is_uncut=False):
    """(texels, is_srgb) of an image datablock: (H, W, 4), row 0 is the bottom; alpha is 1 where it does not count.

    As Cycles has them: uint8, colours encoded by sRGB or linear and, as they are encoded, multiplied by alpha; or float32,
    scene-linear and multiplied by alpha. `frame` is the number of the picture in a sequence or movie; `is_uncut`: colours
    will be divided by alpha again. None for an image that is missing or None.
    """
    image = image and image.original
    found = image and _read(image, frame)
    return _texels(image, *found, is_uncut) if found else None


def tiles_of(image, is_uncut=False):
    """((number, (texels, is_srgb) or None where it is missing), ...) of a tiled image."""
    image = image.original
    found, packed = [], {_name(f.filepath): f for f in image.packed_files}
    for tile, path in zip(image.tiles, paths_of(image), strict=True):
        content = packed.get(_name(path))
        read = pixels_of_data(content.packed_file.data, path, image) if content else pixels_of_file(path, image)
        if not read and len(image.tiles) == 1:
            # It was never saved.
            pixels = pixels_in(image)
            read = None if pixels is None else (pixels, image.is_float)
        found.append((tile.number, _texels(image, *read, is_uncut) if read else None))
    return tuple(found)


def linear_pixels(image, frame=None):
    """(4, H, W) float32: red, green, blue, scene-linear and multiplied by alpha, and alpha; row 0 is the top.

    None for an image that is missing or None.
    """
    found = texels_of(image, frame)
    if found is None:
        return None
    texels, is_srgb = found
    pixels = np.moveaxis(texels[::-1], 2, 0)
    if texels.dtype != np.uint8:
        return np.ascontiguousarray(pixels)
    shares = (np.arange(256) / 255).astype(np.float32)
    result = shares.take(pixels)
    if is_srgb:
        result[:3] = _srgb_to_linear(shares).astype(np.float32).take(pixels[:3])
    return result


def note_missing(note, image, tile=None):
    """Tell `note`, a function (what, kind), that an image (or None), or a tile of it by number, is rendered magenta."""
    of_tile = "" if tile is None else f"tile {tile} of "
    note(f"{of_tile}the image {repr(image.name) + ' ' if image else ''}is missing and is rendered magenta", MISSING)


def paths_of(image, frame=None):
    """The paths of the files that an image datablock shows, whether they are there or not: of its tiles; of a `frame` of a sequence."""
    path = image.filepath
    if image.source == "TILED":
        numbers = [tile.number for tile in image.tiles]
        found = [path.replace("<UDIM>", str(number)).replace("<UVTILE>", _uv_name(number)) for number in numbers]
    else:
        found = [_numbered(path, frame) if image.source == "SEQUENCE" else path]
    return tuple(bpy.path.abspath(path, library=image.library) for path in found)


def is_cut_by_alpha(image):
    """Whether the colours of an image are multiplied by its alpha; what is no colour is not."""
    return bool(image) and image.alpha_mode not in ("NONE", "CHANNEL_PACKED") and not image.colorspace_settings.is_data


def _read(image, frame):
    """(pixels, is_float), or None."""
    if image.source == "SEQUENCE":
        return pixels_of_file(*paths_of(image, frame), image)
    # A movie has a colour space when its pixels have been looked at.
    if image.source == "MOVIE" and len(image.pixels):
        return pixels_of_file(*paths_of(image), image, frame)
    pixels = pixels_in(image)
    return None if pixels is None else (pixels, image.is_float)


def _numbered(path, frame):
    """The path of a picture of a sequence: the last number in the name of any of its files is the frame's."""
    return re.sub(r"\d+(?=[^\d/\\]*(\.[^./\\]*)?$)", lambda digits: f"{max(frame, 0):0{len(digits[0])}d}", path, count=1)


def has_codes_cut(image):
    """Whether Cycles multiplies by alpha the codes of an image that Blender hands out as light: PNG files of sixteen bits."""
    is_srgb = image.colorspace_settings.name == "sRGB"
    return is_srgb and image.file_format == "PNG" and is_cut_by_alpha(image) and image.original.is_float


def _texels(image, pixels, is_float, is_uncut):
    """See `texels_of`."""
    space = image.colorspace_settings
    pixels = _of_four(pixels)
    if image.alpha_mode == "NONE":
        pixels[..., 3] = 1
    if is_float:
        if has_codes_cut(image) and not is_uncut:
            alpha = pixels[..., 3:]
            pixels[..., :3] = _srgb_to_linear(_encoded(pixels[..., :3] / np.where(alpha > 0, alpha, 1)) * alpha)
        return pixels, False
    is_srgb = space.name == "sRGB"
    if not (is_srgb or space.is_data or space.name in _PLAIN):
        pixels = scene_linear(pixels, space.name)
        if is_cut_by_alpha(image):
            pixels[..., :3] *= pixels[..., 3:]
        return pixels, False
    pixels *= 255
    pixels += 0.5
    texels = pixels.astype(np.uint8)
    if is_cut_by_alpha(image) and texels[..., 3].min() < 255:
        # As Cycles has it: bytes are multiplied as they are encoded.
        texels[..., :3] = texels[..., :3].astype(np.uint16) * texels[..., 3:] // 255
    return texels, is_srgb


def _of_four(pixels):
    """(H, W, 4) of (H, W, 1 to 4): one channel, with or without alpha, is grey."""
    height, width, channels = pixels.shape
    if channels == 4:
        return pixels
    result = np.ones((height, width, 4), np.float32)
    result[..., :3] = pixels if channels == 3 else pixels[..., :1]
    if channels == 2:
        result[..., 3] = pixels[..., 1]
    return result


def _name(path):
    return bpy.path.basename(path)


def _uv_name(number):
    """A tile's number as Mudbox counts: from 1 in both directions."""
    row, column = divmod(number - 1001, 10)
    return f"u{column + 1}_v{row + 1}"


def _encoded(c):
    """The inverse of `_srgb_to_linear`."""
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * np.maximum(c, 0) ** (1 / 2.4) - 0.055)


def _srgb_to_linear(c):
    """IEC 61966-2-1."""
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
