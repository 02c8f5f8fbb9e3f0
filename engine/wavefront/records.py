"""What travels between the stages."""

from dataclasses import dataclass, field

import numpy as np

from ..arrays import Columns, gather


@dataclass(frozen=True, slots=True, eq=False)
class Rays:
    """A batch of N rays of one depth.

    o, d    (3, N) origins and unit directions, render space
    beta    (3, N) path throughput
    pdf     (N,) density with which d was sampled [sr^-1]; camera rays have none, (0,)
    slot    (N,) where in the film each path collects its light
    key     (N,) uint32, the hash of each path's pixel
    sample  (N,) uint32, each path's sample
    depth   bounces behind these rays; 0 leaves the camera
    split   how many rays of this depth stand for one sample of the pixel; their `sample` numbers count them all
    stream  which of the specular directions were taken; 0 where there never was a choice
    carried what features take along a path, a column each; none where nothing asks for it
    """

    o: np.ndarray
    d: np.ndarray
    beta: np.ndarray
    pdf: np.ndarray
    slot: np.ndarray
    key: np.ndarray
    sample: np.ndarray
    depth: int
    split: int = 1
    stream: int = 0
    carried: Columns = field(default_factory=Columns)

    @property
    def time(self):
        """(N,) in [0, 1), from the opening of the shutter to its closing; None where nothing moves."""
        return getattr(self.carried, "time", None)

    @property
    def facing(self):
        """(3, N) the normals on the side that rays have left; None where no choice of a light minds it."""
        return getattr(self.carried, "facing", None)

    @classmethod
    def joined(cls, batches):
        """All rays of `batches`, a list of one depth, split and stream, none of them from the camera, one batch after the other."""
        if len(batches) == 1:
            return batches[0]
        first = batches[0]
        names = ("o", "d", "beta", "pdf", "slot", "key", "sample")
        columns = (np.concatenate([getattr(rays, name) for rays in batches], axis=-1) for name in names)
        carried = {name: np.concatenate([getattr(rays.carried, name) for rays in batches], axis=-1) for name in vars(first.carried)}
        return cls(*columns, first.depth, first.split, first.stream, Columns(**carried))

    def landed(self, lanes):
        """The rays `lanes` (M,) for what happens where they hit: origins and densities have done their work."""
        return Rays(
            self.o[:, :0],
            gather(self.d, lanes),
            gather(self.beta, lanes),
            self.pdf[:0],
            gather(self.slot, lanes),
            gather(self.key, lanes),
            gather(self.sample, lanes),
            self.depth,
            self.split,
            self.stream,
            self.carried.take(lanes),
        )

    def take(self, lanes):
        """The rays `lanes` (M,)."""
        return Rays(
            gather(self.o, lanes),
            gather(self.d, lanes),
            gather(self.beta, lanes),
            gather(self.pdf, lanes) if self.depth else self.pdf,
            gather(self.slot, lanes),
            gather(self.key, lanes),
            gather(self.sample, lanes),
            self.depth,
            self.split,
            self.stream,
            self.carried.take(lanes),
        )
