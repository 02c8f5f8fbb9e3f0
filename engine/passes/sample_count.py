"""How many samples each pixel took."""

import numpy as np

from . import registry


@registry.add
class SampleCount:
    """Paths that began in the pixel, those of cells that were divided later included; the same everywhere unless adaptive."""

    key = "Sample Count"
    label = "Sample Count"
    channels = "X"
    at_first_hit = False
    reduction = "sum"

    @staticmethod
    def gather(radiance, first_hits):
        return np.ones_like(radiance[:1])
