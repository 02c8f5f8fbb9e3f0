"""Points as rays look at them: what textures can ask about the ray, and about the surface that it met."""

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from ..arrays import Columns
from ..world.accel import Hits
from .light_path import is_past, past_of

_LEAST_PIXEL = np.float32(2.0**-14)
"""Of a triangle's extent: heights much closer together than this differ by the rounding of their places."""


class RayView:
    """Points on surfaces as the `lanes` (M,) of `rays` look at them (None: all), which have come over t (M,).

    Nothing is worked out before a texture asks for it. `is_shadow`: the rays are those of shadows, which have passed to here.
    """

    def __init__(self, plan, rays, t, lanes=None, is_shadow=False):
        self._plan, self._all, self._lanes, self._t, self._is_shadow = plan, rays, lanes, t, is_shadow

    def take(self, lanes):
        """The points `lanes`."""
        chosen = lanes if self._lanes is None else self._lanes.take(lanes)
        return RayView(self._plan, self._all, self._t.take(lanes), chosen, self._is_shadow)

    @property
    def is_even(self):
        """(M,) as rays carry it, see `cones`; None where they do not."""
        found = getattr(self._all.carried, "is_even", None)
        return found if found is None or self._lanes is None else found.take(self._lanes)

    @cached_property
    def _rays(self):
        return self._all if self._lanes is None else self._all.landed(self._lanes)

    @property
    def d(self):
        """(3, M) the directions of the rays, unit."""
        return self._rays.d

    @property
    def frame(self):
        """The `Frame` of render space."""
        return self._plan.world.frame

    @property
    def camera(self):
        """The `CameraSpace`."""
        return self._plan.world.camera

    def surface(self, prim, u, v):
        """The `Surface` at places u, v (M,) of the triangles `prim` (M,), as it is without relief."""
        # Rays have not landed there, whatever they carry as if they had.
        rays = replace(self._rays, carried=Columns(**vars(self._rays.carried)))
        return self._plan.interact(self._plan, rays, Hits(prim, self._t, u, v))

    def edges(self, prim):
        """The edges of triangles, two (3, M), render space."""
        return self._plan.edges(self._plan, self._rays.carried, prim)

    def pixel(self, prim):
        """How wide (M,) a pixel is where the rays met triangles, render space; never less than what places are rounded to."""
        carried = self._rays.carried
        # Of N samples each has a cone for one N-th of the pixel.
        cone = carried.extent if hasattr(carried, "extent") else carried.width + carried.spread * self._t
        pixel = cone * np.float32(math.sqrt(self._plan.settings.samples))
        return np.maximum(pixel, _LEAST_PIXEL * self._plan.world.triangles.extent.take(prim))

    def turned(self, prim, a):
        """Vectors a (3, M) of objects as they are placed at the middle of the shutter, as they are at the time of the rays."""
        movers = self._plan.world.movers
        lanes = np.nonzero(prim >= movers.first)[0] if movers else ()
        if not len(lanes):
            return a
        owner, result = movers.owner.take(prim.take(lanes) - movers.first), np.array(a)
        middle = movers.poses.at(owner, np.full(lanes.size, 0.5, np.float32))
        result[:, lanes] = movers.poses.at(owner, self._rays.time.take(lanes)).vectors(middle.local_vectors(a.take(lanes, axis=1)))
        return result

    def around(self, surface):
        """The index of refraction, 1 or (M,), of what is around the bodies whose `surface` the rays met."""
        return self._plan.around(self._plan, self._rays, surface)[0]

    def path(self, output):
        """What `LightPath` says, float32 (1, 1) or (1, M)."""
        rays = self._rays
        if output == "length":
            return self._t[None] / np.float32(self.frame.scale)
        if is_past(output):
            return past_of(rays, output, self._is_shadow)
        told = {"camera": rays.depth == 0 and not self._is_shadow, "shadow": self._is_shadow, "depth": rays.depth + self._is_shadow}
        return np.full((1, 1), told[output], np.float32)
