"""How much of an outer layer is seen."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.facing import facing_fresnel, schlick_facing
from ..maths.vectors import as_vector, dot
from . import registry


@registry.add
@dataclass(frozen=True, eq=False)
class LayerWeight:
    """From what faces the viewer to the rim, where it is 1.

    blend   0 to 1: how much of the surface is rim
    normal  unit, world space; None: the shading normal
    output  "facing": 1 - |cos|^e; "fresnel": what a boundary of index 1 / (1 - blend) reflects
    """

    key = "layer weight"
    label = "Layer Weight"
    is_pure = False

    blend: object = 0.5
    normal: object = None
    output: str = "facing"

    @property
    def asks_for_cosine(self):
        """See `interfaces.asks_for_cosine`."""
        return self.normal is None

    def check(self, owner):
        if self.output not in ("facing", "fresnel"):
            raise SceneError(f"{owner}: output of its layer weight is '{self.output}', allowed: facing, fresnel")

    def eval(self, at):
        cos = dot(at.d, at.surface.ns if self.normal is None else as_vector(at.value(self.normal)))
        blend = at.value(self.blend)[0]
        if self.output == "facing":
            return schlick_facing(cos, blend)[None]
        # Seen from outside the index is 1 / (1 - blend).
        return facing_fresnel(cos, 1 - np.asarray(blend), ~at.surface.is_front)[None]
