"""Blender's images as arrays of scene-linear numbers."""

import numpy as np

MISSING = (1.0, 0.0, 1.0, 1.0)
"""Magenta: what Blender shows for an image that it cannot find."""


def linear_pixels(image, findings, owner):
    """(4, H, W) float32: red, green, blue, scene-linear and multiplied by alpha, and alpha; row 0 is the top.

    Blender hands out floating-point images in just that form; bytes are encoded as their colour space says, with straight
    alpha. An image that is missing, or None, is one pixel of magenta and noted for `owner`.
    """
    image = image and image.original
    # The first look at the pixels loads the file; only then its size is known.
    count = len(image.pixels) if image else 0
    if not count:
        findings.note(f"the image {repr(image.name) + ' ' if image else ''}is missing and is rendered magenta", owner)
        return np.array(MISSING, np.float32)[:, None, None]
    if image.source in ("SEQUENCE", "MOVIE", "TILED"):
        findings.note(f"of the image '{image.name}' only what Blender shows of it is rendered: it is a {image.source.lower()}", owner)
    width, height = image.size
    pixels = np.empty(count, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, -1)[::-1]
    channels = pixels.shape[2]
    has_alpha = channels == 4 and image.alpha_mode != "NONE"
    result = np.ones((4, height, width), np.float32)
    # One channel is grey.
    result[:3] = np.moveaxis(pixels[..., :3] if channels >= 3 else pixels[..., :1], 2, 0)
    if has_alpha:
        result[3] = pixels[..., 3]
    if not image.is_float:
        result[:3] = _decoded(result[:3], image, findings, owner)
        if has_alpha and image.alpha_mode != "CHANNEL_PACKED":
            result[:3] *= result[3]
    return result


def _decoded(values, image, findings, owner):
    """Encoded bytes / 255 as scene-linear numbers."""
    space = image.colorspace_settings
    # Known by name: Blender's own files only differ in these, and is_data marks what is no colour.
    if space.is_data or space.name.startswith("Linear"):
        return values
    if space.name != "sRGB":
        findings.note(f"the colour space {space.name} of the image '{image.name}' is taken for sRGB", owner)
    return _LINEAR_OF_BYTE.take((values * 255 + 0.5).astype(np.uint8))


def _srgb_to_linear(c):
    """IEC 61966-2-1."""
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


_LINEAR_OF_BYTE = _srgb_to_linear(np.arange(256) / 255).astype(np.float32)
