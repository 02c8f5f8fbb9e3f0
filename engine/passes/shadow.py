"""What is left of the light of lights where something is in its way."""

import numpy as np

from ..maths.vectors import dot
from ..scene.textured import luminance
from ..wavefront.passing import opacity
from ..wavefront.recording import FirstHit
from . import registry

_CHANNELS = "RGB"


@registry.add
class Shadow(FirstHit):
    """Irradiance by lights where camera rays hit, over what it were if nothing were in the way: 1 lit, 0 in the dark or where none shines.

    Both are averaged over what covers the pixel. Lights are lamps, glowing meshes and a picture of the world; a world that is the
    same everywhere is none. Light counts on the side of the viewer, and from behind by the share of what lobes send on that is
    transmitted.
    """

    key = divided_by = "Shadow"
    label = "Shadow"
    channels = _CHANNELS
    rows = 2 * len(_CHANNELS)
    sends_shadow_rays = True
    covers = True

    @staticmethod
    def values(plan, rays, surface, reflection):
        arrives, sent = np.zeros((2, *surface.wo.shape), np.float32)
        covered = opacity(plan, rays, surface)
        for light, wi, distance, E in plan.to_lights(plan, rays, surface):
            E = E * (covered * reflection.cosine(surface, wi) * _share(reflection, surface, wi))
            # What is no number is none.
            E = np.nan_to_num(plan.lit_lobes(plan, surface, reflection, wi, E, light), nan=0, posinf=0, neginf=0)
            sent += E
            shadow = plan.shadow_rays(plan, rays, surface, reflection, wi, distance)
            lanes, share = plan.unblocked(plan, *shadow, E.any(axis=0))
            arrives[:, lanes] += E.take(lanes, axis=1) * share
        return np.concatenate((arrives, sent))


def _share(reflection, surface, wi):
    """How much light from wi (3, N) counts, (N,): where no lobe transmits all that comes from the viewer's side."""
    behind = dot(surface.n, wi) < 0
    albedos = [(lobe.bsdf.transmits, luminance(lobe.bsdf.albedo(lobe.k))) for lobe in reflection.rough]
    through = sum(albedo for transmits, albedo in albedos if transmits)
    whole = sum(albedo for _, albedo in albedos)
    through = np.divide(through, whole, out=np.zeros_like(wi[0]), where=whole > 0)
    return np.where(behind, through, 1 - through)
