"""The colour of heat."""

from dataclasses import dataclass

from ..maths.observer import glow
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Blackbody:
    """The colour of a black body of `temperature` [K] and luminance 1; below 800 K and above 12,000 K it stays what it is there."""

    key = "blackbody"
    label = "Blackbody"

    temperature: object = 1500.0

    def check(self, owner):
        pass

    def eval(self, at):
        return glow(at.value(self.temperature))
