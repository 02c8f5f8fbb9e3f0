"""Pictures that textures show: shared by all that use them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import frozen
from ..errors import SceneError
from ..maths.mipmaps import Pyramid, decoding_table


@dataclass(frozen=True, kw_only=True, eq=False)
class Bitmap:
    """A picture of H x W texels, linear Rec. 709 once decoded.

    pixels   (3, H, W) uint8, or float32, which is linear already; the first row is the lowest
    is_srgb  bytes are encoded by the sRGB curve (IEC 61966-2-1); else they are linear, 255 is 1
    Raises SceneError where the shape does not fit.
    """

    name: str
    pixels: np.ndarray
    is_srgb: bool = True

    def __post_init__(self):
        dtype = np.uint8 if getattr(self.pixels, "dtype", None) == np.uint8 else np.float32
        try:
            pixels = frozen(self.pixels, dtype, (3, None, None), f"image '{self.name}'", "pixels")
        except ValueError as error:
            raise SceneError(str(error)) from None
        if not pixels.size:
            raise SceneError(f"image '{self.name}': it has no pixels")
        object.__setattr__(self, "pixels", pixels)

    @cached_property
    def pyramid(self):
        """The `Pyramid` of its mip maps."""
        return Pyramid.of(self.pixels, self.is_srgb)

    @cached_property
    def mean(self):
        """(r, g, b) of the whole picture, linear."""
        if self.pixels.dtype == np.uint8:
            return tuple((self._counts @ decoding_table(self.is_srgb) / self.pixels[0].size).tolist())
        return tuple(self.pixels.mean(axis=(1, 2), dtype=np.float64).tolist())

    @cached_property
    def bounds(self):
        """The least and the largest value of each channel, linear: two (r, g, b)."""
        ends = self.pixels.min(axis=(1, 2)), self.pixels.max(axis=(1, 2))
        if self.pixels.dtype == np.uint8:
            ends = [decoding_table(self.is_srgb).take(end) for end in ends]
        return tuple(tuple(map(float, end)) for end in ends)

    @cached_property
    def _counts(self):
        """How often each byte occurs, (3, 256)."""
        # Row by row, as counting takes eight bytes for each one that it counts.
        return np.stack([sum(np.bincount(row, minlength=256) for row in channel) for channel in self.pixels])
