"""Vectors placed, turned and scaled."""

from dataclasses import dataclass

from ..errors import SceneError
from ..maths.arithmetic import divided
from ..maths.rotations import turned
from ..maths.vectors import as_vector, length
from . import registry


def _point(p, location, rotation, scale):
    return turned(p * scale, rotation) + location


def _texture(p, location, rotation, scale):
    return divided(turned(p - location, rotation, is_inverted=True), scale)


def _vector(p, location, rotation, scale):
    return turned(p * scale, rotation)


def _normal(p, location, rotation, scale):
    n = turned(divided(p, scale), rotation)
    return divided(n, length(n))


_KINDS = {"point": _point, "texture": _texture, "vector": _vector, "normal": _normal}


@registry.add
@dataclass(frozen=True, eq=False)
class Mapping:
    """Blender's Mapping: `vector` scaled, turned about x, y and z [rad], and moved, as a point.

    kind  "texture": the other way round; "vector": not moved; "normal": as what is perpendicular to a surface, and unit
    """

    key = "mapping"
    label = "Mapping"

    vector: object = (0.0, 0.0, 0.0)
    location: object = (0.0, 0.0, 0.0)
    rotation: object = (0.0, 0.0, 0.0)
    scale: object = (1.0, 1.0, 1.0)
    kind: str = "point"

    def check(self, owner):
        if self.kind not in _KINDS:
            raise SceneError(f"{owner}: kind of Mapping is '{self.kind}', allowed: {', '.join(_KINDS)}")

    def eval(self, at):
        return _KINDS[self.kind](*(as_vector(at.value(x)) for x in (self.vector, self.location, self.rotation, self.scale)))
