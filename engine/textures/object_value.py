"""What is known of objects, the same all over each."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from . import registry

_OUTPUTS = {
    "colour": lambda value: value[:3],
    "number": lambda value: value[:1],
    "mean": lambda value: ((value[0] + value[1] + value[2]) * np.float32(1 / 3))[None],
    "alpha": lambda value: value[3:],
}


@registry.add
@dataclass(frozen=True, eq=False)
class ObjectValue:
    """One of `Object.values` by its name, or "location", where the object is [m]; 0 where an object has none of the name.

    output  "colour", the first three numbers; "number", the first; "mean" of the first three; "alpha", the fourth
    """

    key = "object value"
    label = "Object Value"
    is_pure = False

    name: str = "location"
    output: str = "colour"

    def check(self, owner):
        if self.output not in _OUTPUTS:
            raise SceneError(f"{owner}: output of its object value is '{self.output}', allowed: {', '.join(_OUTPUTS)}")

    @property
    def attributes(self):
        """What objects must bring, see `world.attributes`."""
        return (("value", self.name),)

    def eval(self, at):
        return _OUTPUTS[self.output](at.attribute(self.attributes[0])[0])
