"""Independent random numbers: the baseline that every other sampler is measured against."""

from ..maths.hashing import mix, mix_int, to_unit, to_unit2
from . import registry


@registry.add
class Random:
    """Independent numbers: simplest to reason about, most noise; error falls as 1 / sqrt(samples)."""

    key = "random"
    label = "Random"

    @staticmethod
    def one(key, sample, dimension, samples):
        return to_unit(mix(mix(key ^ mix_int(dimension)) ^ sample))

    @staticmethod
    def two(key, sample, dimension, samples):
        return to_unit2(mix(mix(key ^ mix_int(dimension)) ^ sample))
