"""What meshes bring besides their shape."""

from dataclasses import dataclass

from ..errors import SceneError
from . import registry

_SOURCES = {"colour": "attribute", "number": "number", "alpha": "alpha", "opacity": "colour alpha"}


@registry.add
@dataclass(frozen=True, eq=False)
class Attribute:
    """A `MeshAttribute` by its name: 0, and wholly there, where a mesh has none.

    output  "colour", of a number three times the same; "number", the mean of a vector or colour; "alpha", 1 for all but colours;
            "opacity", the same, but 0 where a mesh has none
    """

    key = "attribute"
    label = "Attribute"
    is_pure = False

    name: str = ""
    output: str = "colour"

    def check(self, owner):
        if self.output not in _SOURCES:
            raise SceneError(f"{owner}: output of its attribute is '{self.output}', allowed: {', '.join(_SOURCES)}")

    @property
    def attributes(self):
        """What meshes must bring, see `world.attributes`."""
        return ((_SOURCES[self.output], self.name),)

    def eval(self, at):
        return at.attribute(self.attributes[0])[0]
