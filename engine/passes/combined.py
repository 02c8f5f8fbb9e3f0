"""The picture."""

import numpy as np

from . import registry


@registry.add
class Combined:
    """Radiance, linear Rec. 709 [W m^-2 sr^-1], and alpha, premultiplied."""

    key = "Combined"
    label = "Combined"
    channels = "RGBA"
    at_first_hit = False
    reduction = "mean"

    @staticmethod
    def gather(radiance, first_hits):
        return np.concatenate((radiance, np.ones_like(radiance[:1])))
