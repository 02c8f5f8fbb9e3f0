"""Blender's images as arrays of numbers."""

import numpy as np

MISSING = (1.0, 0.0, 1.0, 1.0)
"""Magenta: what Blender shows for an image that it cannot find."""


def stored_pixels(image, findings, owner):
    """(H, W, 1 to 4) float32 as Blender hands an image out, row 0 is the bottom: bytes / 255, or scene-linear numbers.

    None, with a note for `owner`, for an image that is missing or None.
    """
    image = image and image.original
    # The first look at the pixels loads the file; only then its size is known.
    count = len(image.pixels) if image else 0
    if not count:
        findings.note(f"the image {repr(image.name) + ' ' if image else ''}is missing and is rendered magenta", owner)
        return None
    if image.source in ("SEQUENCE", "MOVIE", "TILED"):
        findings.note(f"of the image '{image.name}' only what Blender shows of it is rendered: it is a {image.source.lower()}", owner)
    width, height = image.size
    pixels = np.empty(count, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, -1)


def is_srgb(image, findings, owner):
    """Whether the bytes of an image are encoded by the sRGB curve; else they are linear."""
    space = image.colorspace_settings
    # Known by name: Blender's own files only differ in these, and is_data marks what is no colour.
    if space.is_data or space.name.startswith("Linear"):
        return False
    if space.name != "sRGB":
        findings.note(f"the colour space {space.name} of the image '{image.name}' is taken for sRGB", owner)
    return True


def weighs_by_alpha(image, channels):
    """Whether the bytes of an image with so many `channels` have an alpha that counts, by which they are yet to be multiplied."""
    return channels == 4 and not image.is_float and image.alpha_mode not in ("NONE", "CHANNEL_PACKED")


def linear_pixels(image, findings, owner):
    """(4, H, W) float32: red, green, blue, scene-linear and multiplied by alpha, and alpha; row 0 is the top.

    Blender hands out floating-point images in just that form; bytes are encoded as their colour space says, with straight
    alpha. An image that is missing, or None, is one pixel of magenta and noted for `owner`.
    """
    pixels = stored_pixels(image, findings, owner)
    if pixels is None:
        return np.array(MISSING, np.float32)[:, None, None]
    pixels = pixels[::-1]
    height, width, channels = pixels.shape
    result = np.ones((4, height, width), np.float32)
    # One channel is grey.
    result[:3] = np.moveaxis(pixels[..., :3] if channels >= 3 else pixels[..., :1], 2, 0)
    if channels == 4 and image.alpha_mode != "NONE":
        result[3] = pixels[..., 3]
    if not image.is_float:
        if is_srgb(image, findings, owner):
            result[:3] = _LINEAR_OF_BYTE.take((result[:3] * 255 + 0.5).astype(np.uint8))
        if weighs_by_alpha(image, channels):
            result[:3] *= result[3]
    return result


def _srgb_to_linear(c):
    """IEC 61966-2-1."""
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


_LINEAR_OF_BYTE = _srgb_to_linear(np.arange(256) / 255).astype(np.float32)
