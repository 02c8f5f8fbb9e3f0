"""Files of images, read by Blender apart from the open file, which is left as it is.

`bpy.data.temp_data` offers a second, empty file for that. Blender decodes and converts; nothing else knows all its formats
and colour spaces.
"""

import os
import tempfile
from pathlib import Path

import bpy
import numpy as np

from ...engine import require_memory


def pixels_in(image):
    """(H, W, 1 to 4) float32 as Blender hands an image out, row 0 is the bottom: bytes / 255, or scene-linear numbers. Or None.

    Raises MemoryShortage, naming the image, where neither they nor what is made of them would fit.
    """
    # The first look at the pixels loads the file; only then its size is known.
    count = len(image.pixels)
    if not count:
        return None
    width, height = image.size
    # As numbers, with four of them for each pixel, and as what is looked up.
    require_memory(4 * count + 40 * width * height, f"the pixels of image '{image.name}', {width}x{height} of them,", "scale it down")
    pixels = np.empty(count, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, -1)


def pixels_of_file(path, like, frame=None):
    """(pixels, is_float) of the image at `path`, read with the settings of the image `like`; None where there is none.

    frame  of a movie, the number of the picture, from 1 on; the first and last are those before and after as well
    """
    if not os.path.isfile(path):
        return None
    with bpy.data.temp_data() as data:
        image = data.images.load(str(path))
        image.colorspace_settings.name = like.colorspace_settings.name
        image.alpha_mode = like.alpha_mode
        image.use_deinterlace = like.use_deinterlace
        pixels = pixels_in(image)
        if frame is not None and pixels is not None:
            if image.source != "MOVIE":
                return None
            # Pixels are those of the picture that was asked for last; scaled to the size that it has it stays as it is.
            image.scale(*image.size, frame=frame)
            pixels = pixels_in(image)
        return None if pixels is None else (pixels, image.is_float)


def pixels_of_data(content, name, like):
    """The same for the content of a packed file, bytes, once called `name`."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"packed{Path(name).suffix}")
        path.write_bytes(content)
        return pixels_of_file(path, like)


def scene_linear(pixels, space):
    """`pixels` (H, W, 4), encoded in the colour space of this name, as Blender has them in scene-linear floats."""
    with tempfile.TemporaryDirectory() as folder, bpy.data.temp_data() as data:
        path = str(Path(folder, "encoded.exr"))
        height, width, _ = pixels.shape
        image = data.images.new("Encoded", width, height, alpha=True, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        opaque = pixels.copy()
        opaque[..., 3] = 1
        image.pixels.foreach_set(opaque.ravel())
        image.filepath_raw, image.file_format = path, "OPEN_EXR"
        image.save()
        again = data.images.load(path)
        again.colorspace_settings.name = space
        result = pixels_in(again)
        result[..., 3] = pixels[..., 3]
        return result
