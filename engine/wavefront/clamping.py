"""Light that is too bright at a time, and cut: less noise for a picture that is too dark. It is off unless it is asked for."""

import numpy as np

from .film import Film


class ClampedFilm(Film):
    """A film that scales light down which is brighter, in its brightest channel, than a limit: by itself, whatever else its path brings.

    limits  [W m^-2 sr^-1] of light that the camera sees itself or that one surface has sent on, and of all other; 0: none

    `light` after `close` is what the batch would have brought, and what is gone of it: sums of all channels.
    """

    def __init__(self, pixels, passes, replicates, real, limits):
        super().__init__(pixels, passes, replicates, real)
        self._limits = limits
        self._removed = 0.0

    def add(self, plan, rays, lanes, L, light, bounces):
        """As every film's, of what is left of `L`."""
        limit = self._limits[bounces > 1]
        brightest = L.max(axis=0)
        # What is not finite goes on, and is counted.
        over = np.nonzero((brightest > limit) & np.isfinite(brightest))[0] if limit else ()
        if len(over):
            before, L = L[:, over], L.copy()
            L[:, over] *= limit / brightest[over]
            self._removed += float((before - L[:, over]).sum(dtype=np.float64))
        super().add(plan, rays, lanes, L, light, bounces)

    def close(self, is_first):
        """As every film's."""
        super().close(is_first)
        # Those that were not finite are black by now.
        self.light = self._removed + float(self.radiance.sum(dtype=np.float64)), self._removed
        self._removed = 0.0
