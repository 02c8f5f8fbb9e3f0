"""The picture."""

import numpy as np

from . import registry


@registry.add
class Combined:
    """Radiance, linear Rec. 709 [W m^-2 sr^-1], and alpha, premultiplied."""

    key = "Combined"
    label = "Combined"
    channels = "RGBA"
    records = ""
    reduction = "mean"
    divided_by = ""

    @staticmethod
    def gather(film):
        return np.concatenate((film.radiance, 1 - film.clear))
