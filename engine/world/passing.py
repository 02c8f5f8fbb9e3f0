"""What passes surfaces straight on, by material."""

from dataclasses import dataclass

import numpy as np

from ..interfaces import albedo_of, is_straight, lets_shadow_rays_pass
from ..scene.graphs import is_texture
from ..scene.textured import averaged, textures_of


@dataclass(frozen=True, slots=True, eq=False)
class Passing:
    """A column for each material; all but `alpha` is about that share of the surface which is there.

    straight       (3, M): the share of light that goes straight on
    transmittance  (3, M): the same, 0 where that is a ray of its own
    albedo         (3, M): what all other lobes, and the illumination model, send on at most
    shadow         (3, M): the share of light that shadow rays bring through
    alpha          (M,): the share of the surface that is there, 1 for cut-outs
    cutouts        {row: the texture that is the alpha of that material}
    veils          {row: the textures whose values are to be added to that material's transmittance}
    shades         {row: the same for `straight` and `shadow`}
    is_clear       (M,) bool: whether rays may pass
    """

    straight: np.ndarray
    transmittance: np.ndarray
    albedo: np.ndarray
    shadow: np.ndarray
    alpha: np.ndarray
    cutouts: dict
    veils: dict
    shades: dict
    is_clear: np.ndarray

    @classmethod
    def of(cls, materials, tints_glass=False, real=np.float32):
        """From `Material` values; `tints_glass` as in `interfaces.Integrator`. Textured transmittances of glass count on average."""
        straight, shadow, other = np.zeros((3, 3, len(materials)))
        shades = {}
        for i, material in enumerate(materials):
            other[:, i] = material.ambient
            for lobe in material.lobes:
                is_veil = is_straight(lobe) and is_texture(lobe.transmittance)
                if is_veil:
                    shades.setdefault(i, []).append(lobe.transmittance)
                if is_straight(lobe) and not is_veil:
                    straight[:, i] += lobe.transmittance
                if not is_straight(lobe) or tints_glass:
                    # All together reflect at most 1, whatever the textures are.
                    other[:, i] += 1 if textures_of(lobe) else albedo_of(lobe)
                if lets_shadow_rays_pass(lobe, tints_glass) and not is_veil:
                    shadow[:, i] += averaged(lobe).transmittance
        cutouts = {row: material.alpha for row, material in enumerate(materials) if is_texture(material.alpha)}
        alpha = np.array([1 if row in cutouts else material.alpha for row, material in enumerate(materials)], real)
        veils = {} if tints_glass else shades
        passed = np.zeros_like(straight) if tints_glass else straight
        is_clear = passed.any(axis=0) | (alpha < 1)
        is_clear[[*cutouts, *veils]] = True
        straight, passed, shadow, other = (share.astype(real) for share in (straight, passed, shadow, other))
        return cls(straight, passed, other, shadow, alpha, cutouts, veils, shades, is_clear)
