"""Pictures."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.mipmaps import EXTENSIONS
from ..scene.bitmap import Bitmap
from ..scene.coordinates import UV
from . import registry

_GREY = Bitmap(name="grey", pixels=np.full((3, 1, 1), 0.5, np.float32))


@registry.add
@dataclass(frozen=True, eq=False)
class ImageTexture:
    """A picture on [0, 1]^2 of the first two coordinates, averaged over what a ray stands for.

    extension  what is beyond: "repeat", "extend" (its border), "clip" (black), "mirror"
    is_smooth  bilinear between the centres of texels; else the texel that holds the point
    """

    key = "image"
    label = "Image"
    has_detail = True

    bitmap: Bitmap = _GREY
    coordinates: object = UV
    extension: str = "repeat"
    is_smooth: bool = True

    def check(self, owner):
        if self.extension not in EXTENSIONS:
            raise SceneError(f"material '{owner}': image extension is '{self.extension}', allowed: {', '.join(EXTENSIONS)}")
        if not np.isfinite(self.bitmap.bounds).all():
            raise SceneError(f"material '{owner}': image '{self.bitmap.name}' has pixels that are not finite")

    def eval(self, at):
        (x, y, _), axes = at.look_up(self.coordinates)
        pyramid = self.bitmap.pyramid
        lookup = pyramid.bilinear if self.is_smooth else pyramid.nearest
        if axes is None:
            return lookup(x, y, self.extension)
        return pyramid.filtered(x, y, [axis[:2] for axis in axes], self.extension, lookup)
