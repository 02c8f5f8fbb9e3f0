"""Directions along surfaces."""

from dataclasses import dataclass

from ..errors import SceneError
from ..maths.facing import around, turned, upright
from . import registry

_AXES = ("x", "y", "z")


@registry.add
@dataclass(frozen=True, eq=False)
class Tangent:
    """A unit vector along the surface, world space: around an axis of the generated coordinates, or along u.

    direction  "x", "y", "z": around that axis; "uv": where u grows
    layer      the uv layer; empty: the mesh's first
    """

    key = "tangent"
    label = "Tangent"
    is_pure = False

    direction: str = "z"
    layer: str = ""

    def check(self, owner):
        if self.direction not in (*_AXES, "uv"):
            raise SceneError(f"{owner}: direction of its tangent is '{self.direction}', allowed: x, y, z, uv")

    @property
    def attributes(self):
        """What meshes and objects must bring, see `world.attributes`."""
        return (("tangent", self.layer) if self.direction == "uv" else ("generated", ""), ("object_from_world", ""))

    def eval(self, at):
        along, matrix = (at.attribute(key)[0] for key in self.attributes)
        along = along[:3] if self.direction == "uv" else around(along, self.direction)
        return upright(at.at_time(turned(matrix, along)), at.surface.ns)
