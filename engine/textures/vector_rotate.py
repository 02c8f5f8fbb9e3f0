"""Vectors turned."""

from dataclasses import dataclass

from ..maths.rotations import about, turned
from ..maths.vectors import as_vector
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class VectorRotate:
    """Blender's Vector Rotate: `vector` turned around `centre`, about `axis` by `angle` [rad].

    is_euler     about x, then y, then z, by the three angles of `axis` instead
    is_inverted  back again
    """

    key = "vector rotate"
    label = "Vector Rotate"

    vector: object = (0.0, 0.0, 0.0)
    centre: object = (0.0, 0.0, 0.0)
    axis: object = (0.0, 0.0, 1.0)
    angle: object = 0.0
    is_euler: bool = False
    is_inverted: bool = False

    def check(self, owner):
        pass

    def eval(self, at):
        vector, centre, axis = (as_vector(at.value(x)) for x in (self.vector, self.centre, self.axis))
        if self.is_euler:
            return turned(vector - centre, axis, self.is_inverted) + centre
        angle = at.value(self.angle)
        return about(axis, -angle if self.is_inverted else angle, vector - centre) + centre
