"""What lamps shine into which directions, as their makers measured it."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..errors import SceneError
from ..maths.facing import unit
from ..maths.vectors import as_vector
from . import registry

_CLOSE = 2.0**-13
"""Degrees that make no difference."""


def _even():
    return np.ones((2, 2))


@registry.add
@dataclass(frozen=True, eq=False)
class IesTexture:
    """`strength` times a table of directions: how much goes along `vector`, whatever its length, where -z is straight down.

    vertical    (V,) angles [degrees] from straight down, upwards; beyond them it is dark
    horizontal  (H,) angles [degrees] about the vertical axis, upwards; from -y towards -x
    intensity   (H, V); between are cubics, as in Cycles
    falls_off   cubics take 0 for what is beyond the ends of the table, as before Blender 5
    `io.ies.parse_ies` makes the tables of a file.
    """

    key = "ies"
    label = "IES Texture"

    vector: object = (0.0, 0.0, -1.0)
    strength: object = 1.0
    vertical: np.ndarray = field(default_factory=lambda: np.array((0.0, 180.0)))
    horizontal: np.ndarray = field(default_factory=lambda: np.array((0.0, 360.0)))
    intensity: np.ndarray = field(default_factory=_even)
    falls_off: bool = False

    def check(self, owner):
        for name in ("vertical", "horizontal"):
            angles = getattr(self, name)
            if angles.ndim != 1 or angles.size < 2 or not (np.diff(angles.astype(np.float32)) > 0).all() or not np.isfinite(angles).all():
                raise SceneError(f"{owner}: {name} angles of an IES Texture are not two or more numbers that grow")
        if self.intensity.shape != (self.horizontal.size, self.vertical.size) or not np.isfinite(self.intensity).all():
            raise SceneError(
                f"{owner}: intensity of an IES Texture is not a finite table of {self.horizontal.size} x {self.vertical.size} numbers"
            )

    @cached_property
    def _padded(self):
        """(H + 2, V + 2) float32, with what cubics take beyond the ends: the end again; straight down, what is before it.

        After the last horizontal angle comes the last but one, as in Cycles. There 360 degrees, rounded, are less than all around.
        """
        count, rows = self.vertical.size, self.horizontal.size
        starts_below = self.vertical[0] < _CLOSE
        table = np.asarray(self.intensity, np.float32)
        table = table[:, [1 if starts_below else 0, *range(count), count - 1]][[0, *range(rows), rows - 2]]
        if self.falls_off:
            table[[0, -1]] = table[:, -1] = 0
            table[:, 0] *= starts_below
        return table

    def eval(self, at):
        x, y, z = unit(as_vector(at.value(self.vector)))
        degrees = np.float32(180 / np.pi)
        theta = np.arccos(np.clip(-z, -1, 1)) * degrees
        phi = np.arctan2(x, y) * degrees + np.float32(180)
        (i, a, h_inside), (j, b, v_inside) = _found(self.horizontal, phi), _found(self.vertical, theta)
        table, width = self._padded.ravel(), self._padded.shape[1]
        rows = [_cubic([table.take((i + m) * width + j + n) for n in range(4)], b) for m in range(4)]
        value = np.maximum(_cubic(rows, a), 0)
        return at.value(self.strength) * np.where(h_inside & v_inside, value, np.float32(0))[None]


def _found(angles, angle):
    """The interval (N,) of `angles` (K,) in which each `angle` (N,) is, how far in it, in [0, 1], and whether it is in any."""
    angles = np.asarray(angles, np.float32)
    i = np.clip(np.searchsorted(angles, angle) - 1, 0, angles.size - 2)
    low, high = angles.take(i), angles.take(i + 1)
    share = np.clip((angle - low) / np.maximum(high - low, np.finfo(np.float32).tiny), 0, 1)
    # Rounding loses none of the ends.
    margin = np.float32(_CLOSE)
    return i, share, (angle >= angles[0] - margin) & (angle <= angles[-1] + margin)


def _cubic(values, x):
    """Catmull and Rom's cubic through the second and the third of four values, at x in [0, 1] between them."""
    a, b, c, d = values
    return np.float32(0.5) * (((d + 3 * (b - c) - a) * x + (2 * a - 5 * b + 4 * c - d)) * x + (c - a)) * x + b
