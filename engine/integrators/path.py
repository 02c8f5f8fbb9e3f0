"""Path tracing: one ray goes on from every surface point (Kajiya 1986), and one goes to a light."""

from ..dimensions import Dimension
from ..wavefront.continuation import go_on
from ..wavefront.direct import add_direct_light, to_one_light
from . import registry


@registry.add
class Path:
    """All light paths, one random direction on from each surface; noise falls with the samples, nothing is left out."""

    key = "path"
    label = "Path Tracing"
    is_complete = True
    samples_lights = True
    splits_white = False
    splits_specular = False
    tints_glass = False
    on_surface = (add_direct_light,)
    to_lights = staticmethod(to_one_light)

    @staticmethod
    def scatter(plan, rays, surface, reflection):
        u1 = plan.choose_lobe(plan, rays)
        wi, weight, pdf = reflection.scatter(surface, u1, plan.numbers.two(rays, Dimension.DIRECTION))
        return go_on(plan, rays, surface, reflection, wi, weight, pdf)
