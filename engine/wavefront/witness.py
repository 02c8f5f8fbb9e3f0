"""Where the light of a sample became a number that is none: its path is followed once more, and every surface is remembered."""

from dataclasses import replace
from functools import partial

import numpy as np

from .camera_rays import camera_rays
from .film import Film
from .loop import none_wait, trace
from .numbers import spread_at


class _Witness(Film):
    """A film of one sample that notices the first light which is not finite."""

    def __init__(self, plan):
        super().__init__(1, plan.passes, plan.settings.replicate_sizes, plan.settings.real)
        # The rays whose surfaces are known, the triangles that they hit, and that of the last path which was as it should be.
        self._rays, self._prims, self._last = None, (), None
        self.prim = None

    def meet_surface(self, rays, hits):
        """Remember which triangles `rays` (N,) have hit."""
        sound = np.isfinite(rays.beta).all(axis=0)
        if sound.any():
            self._rays, self._prims, self._last = rays, hits.prim, int(hits.prim[sound][-1])

    def add(self, plan, rays, lanes, L, light, bounces):
        """As every film's, with an eye on `L`."""
        bad = ~np.isfinite(L).all(axis=0)
        if self.prim is None and bad.any():
            self.prim = int(self._prims[lanes[bad][0]]) if rays is self._rays else self._last
        super().add(plan, rays, lanes, L, light, bounces)


def culprit(plan, pixel, sample):
    """The number of the object at which the light of a `sample` of a `pixel`, a part with one of `tiles.Pixels`, stops to be finite.

    None where all that was added is finite, and only the sum is not, or nothing was hit before.
    """
    plan = spread_at(plan, sample)
    witness = _Witness(plan)

    def interact(plan, rays, hits):
        witness.meet_surface(rays, hits)
        return meet(plan, rays, hits)

    meet = plan.interact
    witness.open(1, slice(0, 1), (), sample)
    # The ray is made only where numbers that are none are expected.
    trace(replace(plan, interact=interact, wait=none_wait), map(partial(camera_rays, plan, pixel, sample), (1,)), witness)
    return None if witness.prim is None else plan.world.triangles.owner(witness.prim)
