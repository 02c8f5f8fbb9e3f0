"""The random numbers of paths: of a sampler, of a pixel and a sample, for a dimension at a depth."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..dimensions import Dimension, place
from ..maths.hashing import mix, mix_int
from ..samplers.random import Random


@dataclass(frozen=True, slots=True)
class Numbers:
    """The random numbers of a render: a sampler and how many samples of a pixel it is to spread over each dimension together.

    Where paths have split, it spreads all their branches. All are multiples of 2^-24, handed out as `real`, a dtype.
    """

    sampler: type
    samples: int
    real: type = np.float32

    def keys(self, px, py, width, seed):
        """What random numbers know a pixel px, py (P,) of the full frame by, uint32; a sampler may have keys of its own."""
        return getattr(self.sampler, "pixel_key", hashed_pixel)(px, py, width, seed)

    def one(self, rays, dimension):
        """u1 (N,) for each ray at its depth."""
        return self._given(self.sampler.one, rays, dimension)

    def independent(self, rays, dimension):
        """u1 (N,) without strata, for decisions that they cannot improve; the same for every sampler."""
        return self._given(Random.one, rays, dimension)

    def two(self, rays, dimension):
        """u2 (2, N) for each ray at its depth."""
        return self._given(self.sampler.two, rays, dimension)

    def _given(self, draw, rays, dimension):
        where = place(dimension, rays.depth) ^ rays.stream
        numbers = draw(rays.key, rays.sample, where, self.samples * rays.split)
        return numbers.astype(self.real, copy=False)


def seed_of(seed, replicate):
    """The seed of a replicate, 0, 1, ...: those of the first are the numbers that there are without replicates."""
    return int(mix_int(int(mix_int(seed)) + replicate * 0x9E3779B9)) if replicate else seed


def hashed_pixel(px, py, width, seed):
    """Keys (P,) uint32 for samplers that treat all pixels alike: nothing is left of where they are."""
    return mix((py * width + px).astype(np.uint32) ^ mix_int(seed))


def only_lobe(plan, rays):
    """There is one lobe: no choice, and no random number."""
    return


def one_of_the_lobes(plan, rays):
    """The number u1 (N,) that chooses a lobe of each surface."""
    return plan.numbers.one(rays, Dimension.LOBE)


def spread_at(plan, sample):
    """The `plan` for batches that begin with `sample`: its random numbers are spread over a replicate of that size."""
    size = plan.replicates.size_at(sample)
    return plan if size == plan.numbers.samples else replace(plan, numbers=replace(plan.numbers, samples=size))


class Layout:
    """Which samples of a pixel are in which replicate, of such `sizes`, one after the other."""

    def __init__(self, sizes):
        self.sizes = np.array(sizes)
        self.ends = np.cumsum(self.sizes)
        self._starts = self.ends - self.sizes
        self.edges = self.ends[:-1][self.sizes[1:] != self.sizes[:-1]]
        """Samples with which replicates of another size begin."""
        self.told = self.ends[1:][self.sizes[1:] == self.sizes[:-1]]
        """Samples after which there are two replicates at least of every size, so that the error of all of them is told."""

    def of(self, samples):
        """(numbers of the replicates, numbers within them) of `samples` (S,)."""
        replicate = np.searchsorted(self.ends, samples, side="right")
        return replicate, samples - self._starts.take(replicate)

    def size_at(self, sample):
        """Samples of the replicate that `sample` is in."""
        return int(self.sizes[np.searchsorted(self.ends, sample, side="right")])


@lru_cache(maxsize=64)
def layout(sizes):
    """The `Layout` of a tuple of sizes."""
    return Layout(sizes)
