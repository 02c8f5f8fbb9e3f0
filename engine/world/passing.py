"""What passes surfaces straight on, by material."""

from dataclasses import dataclass

import numpy as np

from ..interfaces import is_straight, lets_shadow_rays_pass
from ..scene.textured import averaged, brightest


@dataclass(frozen=True, slots=True, eq=False)
class Passing:
    """A column for each material.

    transmittance  (3, M) float32: the share of light that goes straight on
    albedo         (3, M) float32: what all other lobes send on at most
    is_clear       (M,) bool: whether anything goes straight on
    shadow         (3, M) float32: the share of light that shadow rays bring through
    """

    transmittance: np.ndarray
    albedo: np.ndarray
    is_clear: np.ndarray
    shadow: np.ndarray

    @classmethod
    def of(cls, materials, tints_glass=False):
        """From `Material` values; with `tints_glass` shadow rays pass what refracts, too, weakened by its transmittance, textured
        or not on average."""
        straight, shadow, other = np.zeros((3, 3, len(materials)))
        for i, material in enumerate(materials):
            for lobe in material.lobes:
                if is_straight(lobe):
                    straight[:, i] += lobe.transmittance
                else:
                    other[:, i] += brightest(lobe).albedo()
                if lets_shadow_rays_pass(lobe, tints_glass):
                    shadow[:, i] += averaged(lobe).transmittance
        straight, shadow, other = (share.astype(np.float32) for share in (straight, shadow, other))
        return cls(straight, other, straight.any(axis=0), shadow)
