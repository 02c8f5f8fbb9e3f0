"""Independent random numbers: the baseline that every other sampler is measured against."""

import numpy as np

from ..maths.hashing import mix, mix_int, to_unit
from . import registry


@registry.add
class Random:
    """Independent numbers: simplest to reason about, most noise; error falls as 1 / sqrt(samples)."""

    key = "random"
    label = "Random"

    @staticmethod
    def one(key, sample, dimension, samples):
        return to_unit(mix(mix(key ^ mix_int(2 * dimension)) ^ sample))

    @staticmethod
    def two(key, sample, dimension, samples):
        h = mix(mix(key ^ mix_int(2 * dimension)) ^ sample)
        return to_unit(np.stack((h, mix(h ^ mix_int(2 * dimension + 1)))))
