"""One of the three numbers of a value."""

from dataclasses import dataclass

from ..errors import SceneError
from ..maths.colour_models import FROM_RGB
from ..maths.vectors import as_vector
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Separate:
    """The component 0, 1 or 2 of a vector, or of a colour in the colour `model`: rgb, hsv or hsl."""

    key = "separate"
    label = "Separate"

    value: object = (0.0, 0.0, 0.0)
    component: int = 0
    model: str = "rgb"

    def check(self, owner):
        if self.model not in FROM_RGB:
            raise SceneError(f"{owner}: model of Separate is '{self.model}', allowed: {', '.join(FROM_RGB)}")
        if self.component not in (0, 1, 2):
            raise SceneError(f"{owner}: component of Separate is {self.component}, allowed: 0, 1, 2")

    def eval(self, at):
        value = as_vector(at.value(self.value))
        if self.model != "rgb":
            # The other components are asked for as a rule.
            value = at.once((self.model, id(self.value)), lambda: FROM_RGB[self.model](value))
        return value[self.component : self.component + 1]
