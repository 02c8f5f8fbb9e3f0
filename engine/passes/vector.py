"""How things move across the picture."""

from dataclasses import replace

import numpy as np

from ..wavefront.recording import FirstHit
from ..world.views import CameraSpace
from . import registry

_BESIDE = ("before", "after")


@registry.add
class Vector(FirstHit):
    """How far the first sample's point has come across the picture since the frame before, and will go until the next, reversed [px].

    Right and up. 0 where nothing is met. Reversed, as Cycles has it: where the point was, and where it is seen from where it will be.
    """

    key = "Vector"
    label = "Vector"
    channels = "XYZW"
    reduction = "first"
    attributes = (("object", ""), ("world_from_object", ""), *((what, name) for name in _BESIDE for what in ("shift", "change")))

    @staticmethod
    def values(plan, rays, surface, reflection):
        world, settings = plan.world, plan.settings
        size = np.array([[settings.width], [settings.height]], np.float32)

        def of(what, name=""):
            return world.attributes[what, name].at(surface.prim, surface.u, surface.v)[0]

        x, matrix, here = of("object"), of("world_from_object"), world.camera.window(surface.p)[:2]
        ways = []
        for number, (name, sign) in enumerate(zip(_BESIDE, (1, -1))):
            shift = of("shift", name)
            # What moves is added to where it is: what stands still has moved by 0, whatever the rounding of its place.
            move = _applied(shift, x, 1) + _applied(matrix + shift, of("change", name), 0)
            there = _camera(plan, number).window(surface.p + np.float32(world.frame.scale) * move)[:2]
            ways.append(sign * size * (there - here))
        return np.nan_to_num(np.concatenate(ways), nan=0, posinf=0, neginf=0)


def _camera(plan, number):
    """The `CameraSpace` of the frame before (0) or after (1)."""
    beside = plan.scene.camera_beside
    if not len(beside):
        return plan.world.camera
    return CameraSpace.of(replace(plan.scene.camera, world_from_camera=beside[number]), plan.world.frame)


def _applied(rows, x, w):
    """The matrices of which `rows` (12, N) are three rows, times (x, w), (3, N)."""
    return np.stack([sum(rows[4 * i + j] * x[j] for j in range(3)) + w * rows[4 * i + 3] for i in range(3)])
