"""Vectors from one space to another."""

from dataclasses import dataclass

from ..errors import SceneError
from ..maths.facing import turned, unit
from ..maths.vectors import as_vector
from . import registry

_SPACES = ("world", "object", "camera")
_KINDS = ("point", "vector", "normal")


@registry.add
@dataclass(frozen=True, eq=False)
class VectorTransform:
    """A vector of one space in another: world space, that of the object, or that of the camera, which looks along +z.

    kind    "point"; "vector", not moved, but turned and scaled; "normal", which stays at right angles to what it was, unit
    source  the space that it is in; target  the space that it is wanted in
    """

    key = "vector transform"
    label = "Vector Transform"
    is_pure = False

    vector: object = (0.5, 0.5, 0.5)
    kind: str = "vector"
    source: str = "world"
    target: str = "object"

    def check(self, owner):
        for name, allowed in (("kind", _KINDS), ("source", _SPACES), ("target", _SPACES)):
            if getattr(self, name) not in allowed:
                value = getattr(self, name)
                raise SceneError(f"{owner}: {name} of its vector transform is '{value}', allowed: {', '.join(allowed)}")

    @property
    def attributes(self):
        """What objects must bring, see `world.attributes`."""
        return (("world_from_object", ""), ("object_from_world", "")) if "object" in (self.source, self.target) else ()

    def eval(self, at):
        a = as_vector(at.value(self.vector))
        if self.source == self.target:
            return a
        for space, way in ((self.source, 1), (self.target, -1)):
            # By way of the world.
            a = a if space == "world" else self._moved(a, self._matrices(at, space)[::way])
        return unit(a) if self.kind == "normal" else a

    @staticmethod
    def _matrices(at, space):
        """The rows (12, N) of world_from_space and of its inverse."""
        if space == "camera":
            return at.camera.to_world, at.camera.from_world
        return at.attribute(("world_from_object", ""))[0], at.attribute(("object_from_world", ""))[0]

    def _moved(self, a, matrices):
        there, back = matrices
        if self.kind == "normal":
            return turned(back, a)
        moved = there[0::4] * a[0] + there[1::4] * a[1] + there[2::4] * a[2]
        return moved + there[3::4] if self.kind == "point" else moved
