"""Blender's images as the engine's, each loaded once for all textures that show it."""

import numpy as np

from ...engine import Bitmap
from .images import MISSING, is_srgb, stored_pixels, weighs_by_alpha


class Bitmaps:
    """Engine values of the images met so far."""

    def __init__(self, findings):
        self._findings = findings
        self._known = {}

    def of(self, image, owner, part="colour"):
        """The `Bitmap` of an image datablock, magenta where it is None or has no pixels; notes are for `owner`.

        part  "colour", multiplied by alpha; "uncut", the colour where alpha is yet to cut it out; or "alpha", grey
        """
        key = (image and image.name_full, part)
        if key not in self._known:
            self._known[key] = _PARTS[part](image, owner, self._findings)
        return self._known[key]


def _colour(image, owner, findings):
    pixels = stored_pixels(image, findings, owner)
    if pixels is None:
        return _missing()
    if image.is_float:
        return Bitmap(name=image.name, pixels=_channels(pixels))
    pixels *= 255
    pixels += 0.5
    pixels = pixels.astype(np.uint8)
    if weighs_by_alpha(image, pixels.shape[2]) and pixels[..., 3].min() < 255:
        # As Cycles has it: bytes are multiplied as they are encoded.
        pixels[..., :3] = pixels[..., :3].astype(np.uint16) * pixels[..., 3:] // 255
    return Bitmap(name=image.name, pixels=_channels(pixels), is_srgb=is_srgb(image, findings, owner))


def _alpha(image, owner, findings):
    pixels = stored_pixels(image, findings, owner)
    if pixels is None:
        return Bitmap(name="missing", pixels=np.ones((3, 1, 1), np.float32))
    grey = pixels[..., 3:] if _has_alpha(image, pixels) else np.ones_like(pixels[..., :1])
    return Bitmap(name=f"{image.name} alpha", pixels=_channels(grey if image.is_float else _bytes(grey)), is_srgb=False)


def _uncut(image, owner, findings):
    pixels = stored_pixels(image, findings, owner)
    if pixels is None:
        return _missing()
    if not _has_alpha(image, pixels):
        return _colour(image, owner, findings)
    colour, alpha = pixels[..., :3], pixels[..., 3:]
    if image.is_float:
        colour = colour / np.where(alpha > 0, alpha, 1)
    # What is not there has no colour. The average of what is there keeps filters from darkening its edges.
    there = alpha > 0
    average = (colour * alpha).sum(axis=(0, 1), dtype=np.float64) / max(alpha.sum(dtype=np.float64), np.finfo(np.float32).tiny)
    colour = np.where(there, colour, average.astype(np.float32))
    if image.is_float:
        return Bitmap(name=image.name, pixels=_channels(colour))
    return Bitmap(name=image.name, pixels=_channels(_bytes(colour)), is_srgb=is_srgb(image, findings, owner))


_PARTS = {"colour": _colour, "uncut": _uncut, "alpha": _alpha}


def _missing():
    return Bitmap(name="missing", pixels=np.array(MISSING[:3], np.float32)[:, None, None])


def _has_alpha(image, pixels):
    return pixels.shape[2] == 4 and image.alpha_mode != "NONE"


def _bytes(shares):
    return (shares * 255 + 0.5).astype(np.uint8)


def _channels(pixels):
    """(3, H, W) of (H, W, 1 to 4); one channel, with or without alpha, is grey."""
    colours = pixels[..., :3] if pixels.shape[2] >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    return np.ascontiguousarray(np.moveaxis(colours, 2, 0))
