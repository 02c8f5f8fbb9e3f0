"""How things fade with their distance, for the pass that says so; the picture is the same without it."""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError

_FALLOFFS = {"quadratic": np.square, "linear": np.positive, "inverse_quadratic": np.sqrt}


@dataclass(frozen=True, kw_only=True)
class Mist:
    """From nothing at a distance `start` [m] from the camera to all over a way of `depth` [m].

    falloff  how the share of the way counts: "linear", its square ("quadratic") or its root ("inverse_quadratic")
    """

    start: float = 5.0
    depth: float = 25.0
    falloff: str = "quadratic"

    def check(self, owner):
        """Raises SceneError, naming `owner`, for numbers out of range and a falloff that is none."""
        if not (math.isfinite(self.start) and 0 <= self.depth < math.inf):
            raise SceneError(f"{owner}: its mist is from {self.start} m over {self.depth} m, allowed: finite numbers, depth from 0 on")
        if self.falloff not in _FALLOFFS:
            raise SceneError(f"{owner}: falloff of its mist is '{self.falloff}', allowed: {', '.join(_FALLOFFS)}")

    def at(self, distance):
        """How much of things at a `distance` (N,) [m] is gone, in [0, 1]; nothing of any, as in Cycles, where `depth` is 0."""
        share = (distance - np.float32(self.start)) * np.float32(1 / self.depth if self.depth else 0)
        return _FALLOFFS[self.falloff](np.clip(share, 0, 1))
