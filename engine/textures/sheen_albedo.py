"""How much fibres that stand on a surface reflect towards the viewer."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.vectors import dot
from . import registry

_SMOOTHEST, _RIM = 0.05, 0.05
"""Roughness and cosine from which on there were values to fit. Less rough nothing is reflected, but for the rim."""
_FITS = {
    "microfiber": (
        (-0.3279, 0.0, -0.0958),
        (0.1761, -0.2795, 0.6267),
        (0.5769, -0.8246, -1.0715),
        (1.0504, -1.3096, 0.4139),
    ),
    "ashikhmin": (
        (0.0184, 0.0038, -0.0084),
        (-0.1337, -0.0195, 0.0738),
        (0.3916, -0.8644, -0.1798),
        (0.1016, -0.8258, -0.2608),
    ),
}
"""A row for each of 1, sqrt(cos), cos and cos^3, a column for each of 1, 1 / r and 1 / r^2: their sum is the albedo's logarithm."""


@registry.add
@dataclass(frozen=True, eq=False)
class SheenAlbedo:
    """The directional albedo of sheen, (1, N), in [0, 1], most at the rim.

    roughness  Blender's r, 0 to 1; below 0.05 as there
    kind       "microfiber": of Zeltner, Burley and Chiang 2022, "Practical multiple-scattering sheen using linearly transformed
               cosines", fitted to what spheres of it reflect in Cycles at 14 roughnesses, to 0.023 (0.004 RMS);
               "ashikhmin": of Ashikhmin, Premoze and Shirley 2000, "A microfacet-based BRDF generator", section 5.3, with
               exp(-cot^2 / r^2) / (pi r^2 sin^4) for the normals' density, fitted to quadrature, to 0.015 (0.003 RMS)
    """

    key = "sheen albedo"
    label = "Sheen Albedo"
    is_pure = False
    asks_for_cosine = True

    roughness: object = 0.5
    kind: str = "microfiber"

    def check(self, owner):
        if self.kind not in _FITS:
            raise SceneError(f"{owner}: kind of its sheen is '{self.kind}', allowed: {', '.join(_FITS)}")

    def eval(self, at):
        cos = np.clip(np.abs(dot(at.d, at.surface.ns)), _RIM, 1)
        inverse = 1 / np.clip(np.nan_to_num(at.value(self.roughness)[0]), _SMOOTHEST, 1)
        log = np.float32(0)
        for power, (a, b, c) in zip((np.float32(1), np.sqrt(cos), cos, cos * cos * cos), _FITS[self.kind]):
            log = log + power * (a + inverse * (b + inverse * c))
        return np.exp(np.minimum(log, 0))[None]
