"""How many samples each pixel took."""

import numpy as np

from . import registry


@registry.add
class SampleCount:
    """Paths that began in the pixel, those of cells that were divided later included; the same everywhere unless adaptive."""

    key = "Sample Count"
    label = "Sample Count"
    channels = "X"
    records = ""
    reduction = "sum"
    divided_by = ""

    @staticmethod
    def gather(film):
        return np.ones_like(film.clear)
