"""Blender's images as the engine's, each loaded once for all textures that show it."""

import numpy as np

from ...engine import Bitmap
from .images import MISSING, is_srgb, stored_pixels, weighs_by_alpha


class Bitmaps:
    """Engine values of the images met so far."""

    def __init__(self, findings):
        self._findings = findings
        self._known = {}

    def of(self, image, owner):
        """The `Bitmap` of an image datablock, magenta where it is None or has no pixels; notes are for `owner`."""
        key = image and image.name_full
        if key not in self._known:
            self._known[key] = _bitmap(image, owner, self._findings)
        return self._known[key]


def _bitmap(image, owner, findings):
    pixels = stored_pixels(image, findings, owner)
    if pixels is None:
        return Bitmap(name="missing", pixels=np.array(MISSING[:3], np.float32)[:, None, None])
    if image.is_float:
        return Bitmap(name=image.name, pixels=_channels(pixels))
    pixels *= 255
    pixels += 0.5
    pixels = pixels.astype(np.uint8)
    if weighs_by_alpha(image, pixels.shape[2]) and pixels[..., 3].min() < 255:
        # As Cycles has it: bytes are multiplied as they are encoded.
        pixels[..., :3] = pixels[..., :3].astype(np.uint16) * pixels[..., 3:] // 255
    return Bitmap(name=image.name, pixels=_channels(pixels), is_srgb=is_srgb(image, findings, owner))


def _channels(pixels):
    """(3, H, W) of (H, W, 1 to 4); one channel, with or without alpha, is grey."""
    colours = pixels[..., :3] if pixels.shape[2] >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    return np.ascontiguousarray(np.moveaxis(colours, 2, 0))
