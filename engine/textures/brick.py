"""Bricks."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.cellhash import whole
from ..scene.coordinates import GENERATED
from ..scene.placing import numbers, placed
from . import registry

_U = np.uint32
_MASK = _U(0x7FFFFFFF)


@registry.add
@dataclass(frozen=True, eq=False)
class BrickTexture:
    """Blender's wall of bricks, each of some mixture of two colours.

    colour1, colour2, mortar  colours (r, g, b)
    scale                     how fine all is
    mortar_size               how far the mortar reaches into each brick
    mortar_smooth             what part of that is a smooth transition, 0 to 1
    bias                      what is added to the random share of colour2, which is within [0, 1]
    width, height             of each brick
    shift, shift_every        by which part of a brick every so many-th row is moved; 0: none
    squash, squash_every      how much wider the bricks of every so many-th row are; 0: none
    output                    "color", or "fac": 1 for mortar, 0 for bricks
    """

    key = "brick"
    label = "Brick"
    is_pure = False

    coordinates: object = GENERATED
    colour1: object = (0.8, 0.8, 0.8)
    colour2: object = (0.2, 0.2, 0.2)
    mortar: object = (0.0, 0.0, 0.0)
    scale: object = 1.0
    mortar_size: object = 0.02
    mortar_smooth: object = 0.1
    bias: object = 0.0
    width: object = 0.5
    height: object = 0.25
    shift: float = 0.5
    shift_every: int = 2
    squash: float = 1.0
    squash_every: int = 2
    output: str = "color"

    def check(self, owner):
        for name in ("shift", "squash"):
            if not np.isfinite(getattr(self, name)):
                raise SceneError(f"{owner}: brick {name} is {getattr(self, name)}, allowed: finite numbers")
            if getattr(self, f"{name}_every") < 0:
                raise SceneError(f"{owner}: bricks {name} every {getattr(self, f'{name}_every')} rows, allowed: 0 or more")
        if self.output not in ("color", "fac"):
            raise SceneError(f"{owner}: brick gives '{self.output}', allowed: color, fac")

    def eval(self, at):
        p, _ = placed(at, self.coordinates, self.scale)
        tint, mortar = self._layout(*p[:2], at)
        if self.output == "fac":
            return mortar[None]
        colour1, colour2 = at.value(self.colour1), at.value(self.colour2)
        return ((1 - tint) * colour1 + tint * colour2) * (1 - mortar) + at.value(self.mortar) * mortar

    def _layout(self, x, y, at):
        """The share of the second colour in a brick, and of mortar over it, (N,)."""
        size, smooth, bias, width, height = numbers(at, self.mortar_size, self.mortar_smooth, self.bias, self.width, self.height)
        with np.errstate(divide="ignore", invalid="ignore"):
            row = whole(np.floor(y / height))
            if self.shift_every and self.squash_every:
                width = np.where(row % self.squash_every == 0, width * np.float32(self.squash), width)
                x = x + np.where(row % self.shift_every == 0, width * np.float32(self.shift), 0)
            column = whole(np.floor(x / width))
            x, y = x - width * column.astype(np.float32), y - height * row.astype(np.float32)
            tint = np.clip(_random(row, column) + bias, 0, 1)
            inside = np.minimum(np.minimum(x, y), np.minimum(width - x, height - y))
            t = np.where(smooth == 0, 1, np.clip((1 - inside / size) / smooth, 0, 1))
            return tint, np.where(inside >= size, 0, t * t * (3 - 2 * t))


def _random(row, column):
    """A number in [0, 1] of each brick: Blender's integer noise, of Elias 1998, "Perlin Noise"."""
    n = (row.view(_U) << _U(16)) + (column.view(_U) & _U(0xFFFF))
    n = (n + _U(1013)) & _MASK
    n ^= n >> _U(13)
    n = (n * (n * n * _U(60493) + _U(19990303)) + _U(1376312589)) & _MASK
    return np.float32(0.5) * (n.view(np.int32).astype(np.float32) / np.float32(2.0**30))
