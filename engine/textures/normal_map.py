"""Normals as colours."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.facing import turned, unit
from ..maths.vectors import cross
from . import registry

_SPACES = ("tangent", "object", "world", "blender object", "blender world")


@registry.add
@dataclass(frozen=True, eq=False)
class NormalMap:
    """Normals from the colours of `texture`, 2 c - 1.

    strength  scales what leads away from the surface's normal
    layer     the uv layer of the tangent frame; empty: the mesh's first. A mesh without it keeps its normals
    space     what colours are directions of: "tangent", where u grows, where v grows, and the surface's normal; "object", "world";
              "blender object", "blender world", where y and z point the other way
    is_down   green leads to smaller v, as in DirectX
    """

    key = "normal map"
    label = "Normal Map"
    is_pure = False

    texture: object = (0.5, 0.5, 1.0)
    strength: object = 1.0
    layer: str = ""
    space: str = "tangent"
    is_down: bool = False

    def check(self, owner):
        if self.space not in _SPACES:
            raise SceneError(f"{owner}: space of its normal map is '{self.space}', allowed: {', '.join(_SPACES)}")

    @property
    def attributes(self):
        """What meshes and objects must bring, see `world.attributes`."""
        if self.space.endswith("world"):
            return ()
        return (("object_from_world", ""), *((("tangent", self.layer), ("normal", "")) if self.space == "tangent" else ()))

    def eval(self, at):
        x, y, z = 2 * np.broadcast_to(at.value(self.texture), (3, at.count)) - 1
        strength = at.value(self.strength)[0]
        ns, side = at.surface.ns, np.where(at.surface.is_front, np.float32(1), np.float32(-1))
        if self.space == "tangent":
            if self.is_down:
                y = -y
            x, y, z = strength * x, strength * y, 1 + np.clip(strength, 0, 1) * (z - 1)
            tangent, normal = at.attribute(("tangent", self.layer))[0], at.attribute(("normal", ""))[0]
            hand, tangent = tangent[3], tangent[:3]
            mapped = self._to_world(at, unit(x * tangent + y * hand * cross(normal, tangent) + z * normal)) * side
            return np.where(((x != 0) | (y != 0)) & tangent.any(axis=0), mapped, ns)
        if self.space.startswith("blender"):
            y, z = -y, -z
        mapped = unit(np.stack((x, y, z)))
        if self.space.endswith("object"):
            mapped = self._to_world(at, mapped)
        mapped = mapped * side
        return np.where(strength == 1, mapped, unit(ns + (mapped - ns) * np.maximum(strength, 0)))

    @staticmethod
    def _to_world(at, a):
        return unit(at.at_time(turned(at.attribute(("object_from_world", ""))[0], a)))
