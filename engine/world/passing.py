"""What passes surfaces straight on, by material."""

from dataclasses import dataclass

import numpy as np

from ..interfaces import is_straight, lets_shadow_rays_pass
from ..scene.textured import averaged, brightest, is_texture


@dataclass(frozen=True, slots=True, eq=False)
class Passing:
    """A column for each material; all but `alpha` is about that share of the surface which is there.

    transmittance  (3, M) float32: the share of light that goes straight on
    albedo         (3, M) float32: what all other lobes, and the illumination model, send on at most
    shadow         (3, M) float32: the share of light that shadow rays bring through
    alpha          (M,) float32: the share of the surface that is there, 1 for cut-outs
    cutouts        {row: the texture that is the alpha of that material}
    is_clear       (M,) bool: whether anything goes straight on
    """

    transmittance: np.ndarray
    albedo: np.ndarray
    shadow: np.ndarray
    alpha: np.ndarray
    cutouts: dict
    is_clear: np.ndarray

    @classmethod
    def of(cls, materials, tints_glass=False):
        """From `Material` values; `tints_glass` as in `interfaces.Integrator`. Textured transmittances of glass count on average."""
        straight, shadow, other = np.zeros((3, 3, len(materials)))
        for i, material in enumerate(materials):
            other[:, i] = material.ambient
            for lobe in material.lobes:
                if is_straight(lobe) and not tints_glass:
                    straight[:, i] += lobe.transmittance
                else:
                    other[:, i] += brightest(lobe).albedo()
                if lets_shadow_rays_pass(lobe, tints_glass):
                    shadow[:, i] += averaged(lobe).transmittance
        cutouts = {row: material.alpha for row, material in enumerate(materials) if is_texture(material.alpha)}
        alpha = np.array([1 if row in cutouts else material.alpha for row, material in enumerate(materials)], np.float32)
        is_clear = straight.any(axis=0) | (alpha < 1)
        is_clear[list(cutouts)] = True
        straight, shadow, other = (share.astype(np.float32) for share in (straight, shadow, other))
        return cls(straight, other, shadow, alpha, cutouts, is_clear)
