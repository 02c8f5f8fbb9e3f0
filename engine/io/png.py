"""Pictures as PNG files for the screen, 8 bit; the only file that imports Pillow.

The view transform is the plain sRGB curve. What comes from a .blend file goes through Blender's own instead.
"""

import numpy as np

from ..errors import FileError
from .atomic import replacing


def write_png(path, image):
    """Write the pass Combined of `image`, an `Image`, in sRGB with straight alpha.

    The file appears whole or not at all. Raises FileError, naming `path` and the cause.
    """
    try:
        from PIL import Image as Picture
    except ImportError as error:
        cure = "pip install Pillow, or write .exr"
        raise FileError(f"PNG files need the module Pillow, which cannot be loaded ({error}); cure: {cure}") from error
    if "Combined" not in image.passes:
        raise FileError(f"cannot write '{path}': the picture has no pass Combined")
    pixels = to_bytes(image.passes["Combined"])
    with replacing(path) as temporary:
        Picture.fromarray(pixels).save(temporary, "PNG")


def to_bytes(rgba):
    """8-bit sRGB with straight alpha (H, W, 4) uint8 of linear premultiplied `rgba` (H, W, 4); NaN becomes 0."""
    rgba = np.nan_to_num(np.asarray(rgba, np.float32), nan=0.0, posinf=np.inf, neginf=0.0)
    alpha = np.clip(rgba[..., 3:], 0, 1)
    with np.errstate(over="ignore"):
        straight = rgba[..., :3] / np.where(alpha > 0, alpha, 1)
    encoded = np.concatenate((srgb_from_linear(np.clip(straight, 0, 1)), alpha), axis=-1)
    return (encoded * 255 + 0.5).astype(np.uint8)


def srgb_from_linear(linear):
    """The sRGB transfer function on [0, 1] (IEC 61966-2-1:1999, clause 5.2)."""
    curve = 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curve)
