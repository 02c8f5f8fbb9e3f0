"""Render space: the world moved to the camera and scaled by a power of two, so that float32 is at its best.

Both steps happen in float64 before float32 is ever seen. A power of two changes no digit, so a scene scaled by one
renders to the same bits; a shift by exactly representable numbers likewise.
"""

import math
from dataclasses import dataclass

import numpy as np

_MOST = 60
"""The largest exponent of a scale: its square still fits into float32, which intensities need."""


@dataclass(frozen=True)
class Frame:
    """p_render = (p_world - origin) * scale.

    origin  (3,) float64, world space [m]
    scale   a power of two [m^-1]
    """

    origin: np.ndarray
    scale: float

    @classmethod
    def around(cls, origin, distances):
        """Centred on `origin`, scaled so that the median of `distances` (M,) [m] falls into [1/2, 1)."""
        usable = distances[np.isfinite(distances) & (distances > 0)]
        median = float(np.median(usable)) if usable.size else 1.0
        exponent = min(max(math.frexp(median)[1], -_MOST), _MOST)
        return cls(np.asarray(origin, np.float64), math.ldexp(1.0, -exponent))

    def points(self, p):
        """World points (3, N) in render space, float64."""
        result = np.asarray(p, np.float64) - self.origin[:, None]
        result *= self.scale
        return result
