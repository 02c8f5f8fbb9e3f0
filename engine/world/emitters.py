"""The triangles that emit, as lights: pairs that make a parallelogram are one light, the others one each."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Columns
from ..constants import EPS32, LUMINANCE, ONE_MINUS_EPS32, PI
from ..maths.patches import lift
from ..maths.vectors import cross, length
from .moving_lamps import MovingLamps

_LARGEST = 2.0**50
"""The radius of what is larger, in units of render space, where all that is seen is about 1."""


@dataclass(frozen=True, slots=True, eq=False)
class Emitters:
    """The emissive patches of a world: first the parallelograms, then the triangles, then those that move, each object by object.

    k               columns of `maths.patches`; of those that move at the middle of the shutter. The radiance of textured ones is 1,
                    and where there may be any there is a column `prim`: the triangle of each patch
    mean            (3, M) their radiance, on average
    parallelograms  how many of them are
    objects         (M,) ascending within each kind: which object a patch belongs to
    patch           (E,) intp: the patch that each emissive triangle which stands still belongs to, in the order of the triangles
    moving          the `MovingLamps`; None where all stand still
    """

    k: Columns
    mean: np.ndarray
    parallelograms: int
    objects: np.ndarray
    patch: np.ndarray
    moving: MovingLamps | None = None

    @classmethod
    def of(cls, vertices, triangles, normal, radiance, owner, is_textured, prim=None):
        """From vertices (3, V), and for each emissive triangle: vertex indices, normal, radiance (3, E), object (E,).

        Where it `is_textured` (E,) the radiance is its average, and each triangle is a patch of its own. `prim` (E,) are the
        numbers of the triangles, for the column of that name; None: it is not wanted. Columns are of the dtype of `normal`.
        """
        first = _first_of_pairs(vertices, triangles, np.where(is_textured, np.nan, radiance), owner)
        single = np.ones(owner.size, bool)
        single[first] = single[first + 1] = False
        alone = np.nonzero(single)[0]
        patch = np.empty(owner.size, np.intp)
        patch[first] = patch[first + 1] = np.arange(first.size)
        patch[alone] = first.size + np.arange(alone.size)

        lead = np.concatenate((first, alone))
        v0, v1, v2 = vertices.take(triangles.take(lead, axis=1), axis=1).astype(normal.dtype, copy=False).transpose(1, 0, 2)
        # A pair (v0, v1, v2), (v0, v2, v3) spans from v0 to v1 and v3; mirrored, (v0, v2, v1), (v0, v3, v2).
        v2 = v2.copy()
        v1 = v1.copy()
        a, b = triangles.take(first, axis=1), triangles.take(first + 1, axis=1)
        is_mirrored = a[1] == b[2]
        v1[:, : first.size] = vertices.take(np.where(is_mirrored, b[1], a[1]), axis=1)
        v2[:, : first.size] = vertices.take(np.where(is_mirrored, a[2], b[2]), axis=1)
        e1, e2 = v1 - v0, v2 - v0
        area = length(cross(e1.astype(np.float64), e2.astype(np.float64)))
        area[first.size :] *= 0.5
        k = Columns(
            v0=np.ascontiguousarray(v0),
            e1=e1,
            e2=e2,
            normal=normal.take(lead, axis=1),
            lift=lift(v0, e1, e2),
            area=area.astype(normal.dtype),
            radiance=np.where(is_textured, np.float32(1), radiance).take(lead, axis=1),
        )
        if prim is not None:
            k.prim = prim.take(lead)
        return cls(k, radiance.take(lead, axis=1), first.size, owner[lead], patch)

    def followed_by(self, moving):
        """With the `MovingLamps` after them."""
        every = np.arange(moving.count)
        middle, *others = (moving.at(every, np.full(every.size, time, np.float32)) for time in (0.5, 0.25, 0.75))
        # What has no area in the middle may have one before: it must not be left out.
        middle.area = np.max([k.area for k in (middle, *others)], axis=0)
        k = Columns(**{name: np.concatenate((column, getattr(middle, name)), axis=-1) for name, column in vars(self.k).items()})
        mean, objects = np.concatenate((self.mean, moving.mean), axis=1), np.concatenate((self.objects, moving.owner))
        return replace(self, k=k, mean=mean, objects=objects, moving=moving)

    @property
    def count(self):
        """How many patches there are."""
        return self.objects.size

    @property
    def still(self):
        """How many of them stand still: the first ones."""
        return self.count - (self.moving.count if self.moving else 0)

    def power(self):
        """Radiant flux of both sides, luminance, in units of render space squared, (M,) float64.

        Next to none of what has more than any number: it is found where rays meet it, and others are still chosen.
        """
        power = 2 * PI * self.k.area.astype(np.float64) * (np.array(LUMINANCE) @ self.mean.astype(np.float64))
        return np.where(np.isfinite(power), power, np.finfo(np.float64).tiny)

    def weights(self):
        """What each patch weighs, see `interfaces.Light.weight`, as columns (M,) float64; power as luminance."""
        v0, e1, e2 = (edge.astype(np.float64) for edge in (self.k.v0, self.k.e1, self.k.e2))
        is_triangle = np.arange(self.count) >= self.parallelograms
        from_middle = np.where(is_triangle, 1 / 3, 1 / 2) * (e1 + e2)
        corners = np.stack((-from_middle, e1 - from_middle, e2 - from_middle))
        centre = v0 + from_middle
        # The fourth corner of a parallelogram is as far from the middle as the first.
        radius2 = (corners * corners).sum(axis=1).max(axis=0)
        if self.moving:
            radius2[self.still :] += self._swept2(centre[:, self.still :])
        # What is larger than any number would leave none to its neighbours in a tree.
        radius2 = np.where(radius2 < _LARGEST**2, radius2, _LARGEST**2)
        return Columns(
            centre=centre,
            power=self.power() / (2 * PI),
            nearness=np.ones(self.count),
            radius2=radius2,
            axis=np.zeros((3, self.count)),
            cos_edge=np.full(self.count, -1.0),
        )

    def _swept2(self, centre):
        """How far (M,) the patches that move are from `centre` (3, M) at most, squared."""
        every = np.arange(self.moving.count)
        times = (np.full(every.size, time, np.float32) for time in (0, 0.25, 0.75, ONE_MINUS_EPS32))
        away = [k.v0 + (k.e1 + k.e2) / 3 - centre for k in (self.moving.at(every, time) for time in times)]
        return np.max([(a * a).sum(axis=0) for a in away], axis=0)


def _first_of_pairs(vertices, triangles, radiance, owner):
    """The first (P,) of each two triangles that follow each other and make a parallelogram about their shared edge."""
    a, b = triangles[:, :-1], triangles[:, 1:]
    alike = (a[0] == b[0]) & (owner[:-1] == owner[1:]) & (radiance[:, :-1] == radiance[:, 1:]).all(axis=0)
    shares = alike & ((a[2] == b[1]) | (a[1] == b[2]))
    # The diagonal's ends and the two other corners have the same sum, up to the rounding of their coordinates.
    corner_a, corner_b = np.where(a[2] == b[1], a[1], a[2]), np.where(a[2] == b[1], b[2], b[1])
    diagonal = np.where(a[2] == b[1], a[2], a[1])
    v0, v1, v2, v3 = (vertices.take(i, axis=1).astype(np.float64) for i in (a[0], corner_a, diagonal, corner_b))
    rounding = 4 * EPS32 * np.abs(np.stack((v0, v1, v2, v3))).max(axis=(0, 1), initial=0)
    makes_pair = shares & (np.abs(v1 + v3 - v0 - v2) <= rounding).all(axis=0)
    # Of pairs that overlap in a row, every other one.
    index = np.arange(makes_pair.size)
    starts_row = makes_pair & np.append(True, ~makes_pair[:-1])[: index.size]
    start_of_row = np.maximum.accumulate(np.where(starts_row, index, 0))
    return np.nonzero(makes_pair & ((index - start_of_row) % 2 == 0))[0]
