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
        # A surface may hold out more than it covers; less than nothing of it is not there.
        return np.concatenate((film.radiance, np.maximum(1 - film.clear, 0)))
