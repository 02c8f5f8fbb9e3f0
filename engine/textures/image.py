"""Pictures."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.lookup import EXTENSIONS, places
from ..maths.projections import PROJECTIONS, sides_of_box
from ..scene.bitmap import Bitmap
from ..scene.coordinates import UV
from . import registry

_GREY = Bitmap(name="grey", pixels=np.full((3, 1, 1), 0.5, np.float32))
_MISSING = (1.0, 0.0, 1.0)
"""What tiles show that are not there: magenta, with an alpha of 1."""
_OUTPUTS = ("colour", "uncut", "alpha")


@registry.add
@dataclass(frozen=True, eq=False)
class ImageTexture:
    """A picture on [0, 1]^2 of the first two coordinates, averaged over what a ray stands for.

    extension      what is beyond: "repeat", "extend" (its border), "clip" (black), "mirror"
    is_smooth      bilinear between the centres of texels; else the texel that holds the point
    is_cubic       if smooth: by cubic B-splines, which blur
    output         "colour"; "uncut", the colour before alpha cut it out, for pictures where it has; or "alpha", a number
    projection     of points onto the picture: "flat", "sphere", "tube", or "box", onto three sides
    blend          of boxes: over what share of the directions between two sides both are seen
    normal         of boxes: what faces a side, in the frame of the coordinates
    tiles          ((number, `Bitmap`), ...): many pictures instead of one, each on a square of its own; number 1001 is on
                   [0, 1]^2, beside it is 1002, above it 1011
    """

    key = "image"
    label = "Image"
    has_detail = True

    bitmap: Bitmap = _GREY
    coordinates: object = UV
    extension: str = "repeat"
    is_smooth: bool = True
    is_cubic: bool = False
    output: str = "colour"
    projection: str = "flat"
    blend: float = 0.0
    normal: object = (0.0, 0.0, 1.0)
    tiles: tuple = ()

    def check(self, owner):
        for name, value, allowed in (
            ("extension", self.extension, EXTENSIONS),
            ("output", self.output, _OUTPUTS),
            ("projection", self.projection, (*PROJECTIONS, "box")),
        ):
            if value not in allowed:
                raise SceneError(f"{owner}: image {name} is '{value}', allowed: {', '.join(allowed)}")
        if not 0 <= self.blend <= 1:
            raise SceneError(f"{owner}: image blend is {self.blend}, allowed: 0 to 1")
        if not all(isinstance(tile, tuple) and len(tile) == 2 and type(tile[1]) is Bitmap for tile in self.tiles):
            raise SceneError(f"{owner}: image tiles are pairs of a number and a Bitmap")
        for bitmap in (self.bitmap, *(bitmap for _, bitmap in self.tiles)):
            if not bitmap.is_finite:
                raise SceneError(f"{owner}: image '{bitmap.name}' has pixels that are not finite")

    def eval(self, at):
        p, axes = at.look_up(self.coordinates)
        if self.projection == "box":
            return self._on_box(at, p, axes)
        x, y, axes = at.once((self.projection, self.coordinates), lambda: PROJECTIONS[self.projection](p, axes))
        return self._tiled(at, x, y, axes) if self.tiles else self._of(self.bitmap, self._places(at, "xy", x, y, axes))

    @property
    def _interpolation(self):
        return ("cubic" if self.is_cubic else "linear") if self.is_smooth else "closest"

    def _places(self, at, side, x, y, axes):
        """Shared by all pictures of one size that lie alike."""
        layout = self.bitmap.pyramid.layout
        how = layout, self.extension, self._interpolation
        return at.once((side, self.projection, self.coordinates, *how), lambda: places(layout, x, y, axes, *how[1:], at.is_even))

    def _of(self, bitmap, where):
        if self.output == "alpha":
            return bitmap.pyramid.alpha(where)
        return (bitmap.uncut if self.output == "uncut" else bitmap.pyramid).colours(where)

    def _tiled(self, at, x, y, axes):
        column, row = np.floor(x), np.floor(y)
        number = np.where((column >= 0) & (column < 10) & (row >= 0), 1001 + column + 10 * row, 0)
        is_number = self.output == "alpha"
        missing = np.float32((1,) if is_number else _MISSING)[:, None]
        result = np.array(np.broadcast_to(missing, (missing.size, x.size)))
        for own, bitmap in self.tiles:
            lanes = np.nonzero(number == own)[0]
            if lanes.size:
                px, py = (x - column).take(lanes), (y - row).take(lanes)
                across = axes and [axis.take(lanes, axis=1) for axis in axes]
                is_even = None if at.is_even is None else at.is_even.take(lanes)
                where = places(bitmap.pyramid.layout, px, py, across, "extend", self._interpolation, is_even)
                result[:, lanes] = self._of(bitmap, where)
        return result

    def _on_box(self, at, p, axes):
        normal = np.broadcast_to(at.value(self.normal), p.shape)
        total = 0
        for side, (weight, x, y, across) in enumerate(sides_of_box(p, axes, normal, self.blend)):
            total = total + weight * self._of(self.bitmap, self._places(at, (side, self.normal), x, y, across))
        return total
