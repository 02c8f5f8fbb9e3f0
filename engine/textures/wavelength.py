"""The colours of the rainbow."""

from dataclasses import dataclass

from ..maths.observer import spectral_colour
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Wavelength:
    """The colour of light of `wavelength` [nm], 380 to 780; black beyond."""

    key = "wavelength"
    label = "Wavelength"

    wavelength: object = 500.0

    def check(self, owner):
        pass

    def eval(self, at):
        return spectral_colour(at.value(self.wavelength))
