"""The share of light that a smooth boundary reflects."""

from dataclasses import dataclass

from ..maths.facing import facing_fresnel
from ..maths.vectors import as_vector, dot
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class Fresnel:
    """The share of light towards the viewer that a boundary of index `ior` reflects (Born & Wolf, 1.5.2); inside of it, of 1 / ior.

    normal  unit, world space; None: the shading normal
    """

    key = "fresnel"
    label = "Fresnel"
    is_pure = False

    ior: object = 1.5
    normal: object = None

    @property
    def asks_for_cosine(self):
        """See `interfaces.asks_for_cosine`."""
        return self.normal is None

    def check(self, owner):
        pass

    def eval(self, at):
        n = at.surface.ns if self.normal is None else as_vector(at.value(self.normal))
        return facing_fresnel(dot(at.d, n), at.value(self.ior)[0], at.surface.is_front)[None]
