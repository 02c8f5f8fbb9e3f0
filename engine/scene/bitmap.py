"""Pictures that textures show: shared by all that use them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import frozen
from ..errors import SceneError
from ..maths.mipmaps import Pyramid
from ..memory import require

_MIP_MAPS = 6
"""Bytes for each texel: a third of four float32, rounded up."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Bitmap:
    """A picture of H x W texels, linear Rec. 709 once decoded.

    pixels   (3 or 4, H, W) uint8, or float32, which is linear already: red, green, blue, and alpha where it is not 1
             everywhere; the first row is the lowest. What is a view of a contiguous (H, W, 4) is not copied
    is_srgb  bytes of colours are encoded by the sRGB curve (IEC 61966-2-1); else they are linear, 255 is 1
    Raises SceneError where the shape does not fit, MemoryShortage where the picture would not.
    """

    name: str
    pixels: np.ndarray
    is_srgb: bool = True

    def __post_init__(self):
        pixels = self.pixels
        if np.ndim(pixels) == 3:
            height, width = np.shape(pixels)[1:]
            what = f"the pixels of image '{self.name}', {width}x{height} of them, and their mip maps"
            require(height * width * (4 * pixels.itemsize + _MIP_MAPS), what, "scale it down")
        dtype = np.uint8 if getattr(pixels, "dtype", None) == np.uint8 else np.float32
        channels = 4 if np.shape(pixels)[:1] == (4,) else 3
        if channels == 3 or pixels.dtype != dtype or pixels.ndim != 3 or not np.moveaxis(pixels, 0, 2).flags.c_contiguous:
            try:
                pixels = frozen(pixels, dtype, (channels, None, None), f"image '{self.name}'", "pixels")
            except ValueError as error:
                raise SceneError(str(error)) from None
            # All of a texel lies together, as all of it is looked up together.
            texels = np.full((*pixels.shape[1:], 4), 255 if dtype == np.uint8 else 1, dtype)
            texels[..., :channels] = np.moveaxis(pixels, 0, 2)
            pixels = np.moveaxis(texels, 2, 0)
        if not pixels.size:
            raise SceneError(f"image '{self.name}': it has no pixels")
        pixels = pixels.view()
        pixels.flags.writeable = False
        object.__setattr__(self, "_texels", np.moveaxis(pixels, 0, 2))
        object.__setattr__(self, "pixels", pixels[:channels])

    @cached_property
    def pyramid(self):
        """The `Pyramid` of its mip maps."""
        return Pyramid.of(self._texels, self.is_srgb)

    @cached_property
    def uncut(self):
        """The `Pyramid` of a picture whose colours alpha has cut out, as they were before."""
        return Pyramid.of(self._texels, self.is_srgb, is_uncut=True)

    @property
    def is_finite(self):
        """Whether all pixels are numbers."""
        return self.pixels.dtype == np.uint8 or bool(np.isfinite(self.pixels).all())
