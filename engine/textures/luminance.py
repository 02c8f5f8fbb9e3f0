"""Colours as numbers."""

from dataclasses import dataclass

from ..scene.textured import luminance
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Luminance:
    """The luminance of a colour, linear Rec. 709."""

    key = "luminance"
    label = "Luminance"

    colour: object = (1.0, 1.0, 1.0)

    def check(self, owner):
        pass

    def eval(self, at):
        return luminance(at.value(self.colour))[None]
