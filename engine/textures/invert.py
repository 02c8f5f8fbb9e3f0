"""Negatives."""

from dataclasses import dataclass

from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Invert:
    """Blender's Invert: from colour to 1 - colour, by `factor`."""

    key = "invert"
    label = "Invert Color"

    colour: object = (0.0, 0.0, 0.0)
    factor: object = 1.0

    def check(self, owner):
        pass

    def eval(self, at):
        colour, factor = at.value(self.colour), at.value(self.factor)
        return factor * (1 - colour) + (1 - factor) * colour
