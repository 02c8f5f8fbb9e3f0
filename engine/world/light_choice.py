"""Which light a shadow ray is sent to, where there are none to choose from or few; for many see `light_tree_choice`."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..arrays import Columns, gather
from ..constants import ONE_MINUS_EPS32
from ..maths import discrete
from ..maths.vectors import dot

_DARK = 2.0**-8
"""What a light weighs where it should not shine at all, compared to where it does."""

_EVERYWHERE = 2.0**60
"""The size of what has none, in render space, whose largest distances are 2^40."""

_LEAST = 2.0**-10
"""What the weakest light weighs at least, compared to the strongest."""

_AT_ONCE = 40_000
"""Weights that are held at a time: they should stay in the cache. No power of two, or rows would fall onto the same part of it."""


class OnlyLight:
    """There is one light: no choice, and no number spent."""

    minds_side = False

    def choose(self, p, u2, n=None):
        """See `ByPower.choose`; the index is None."""
        return None, 1.0, u2

    def probability(self, index, p, n=None):
        """See `ByPower.probability`."""
        return 1.0


@dataclass(frozen=True, slots=True, eq=False)
class ByPower:
    """In proportion to power, wherever it is needed. cdf (M,) float64, see `maths.discrete`.

    minds_side  whether it matters which way a surface faces
    """

    minds_side = False

    cdf: np.ndarray
    lower: np.ndarray
    share: np.ndarray

    @classmethod
    def of(cls, powers):
        """From the power of each light (M,), any unit, not all 0."""
        cdf = discrete.cumulative(powers)
        share = discrete.probabilities(cdf)
        return cls(cdf, (cdf - share).astype(np.float32), share.astype(np.float32))

    def choose(self, p, u2, n=None):
        """A light for each point p (3, N): indices (N,), their probabilities (N,), and u2 (2, N) for the point on the light.

        n (3, N) is the normal on the side that is to be lit; None: light counts from all sides.
        The first of u2 chooses, and its place within the interval of the chosen light goes on as a number of its own
        (Shirley 1990): strata hold across the parts of a light. Of its 24 bits log2(M) are spent.
        """
        index = discrete.choose(self.cdf, u2[0])
        probability = gather(self.share, index)
        stretched = u2[0] - gather(self.lower, index)
        stretched /= probability
        np.clip(stretched, 0, np.float32(ONE_MINUS_EPS32), out=u2[0])
        return index, probability, u2

    def probability(self, index, p, n=None):
        """The probability (N,) with which `choose` at p (3, N), facing n (3, N), returns the lights `index` (N,)."""
        return gather(self.share, index)


@dataclass(frozen=True, slots=True, eq=False)
class ByPlace:
    """In proportion to power over squared distance, each light weighed at each point. A sun weighs the same everywhere.

    table  what the lights weigh, see `weigh`; (M, 1), vectors (3, M, 1)
    """

    minds_side = False

    table: Columns

    @classmethod
    def of(cls, lights):
        """From `interfaces.Light.weight` as columns (M,) float64, power a number."""
        return cls(weight_table(lights, lights.radius2, (-1, 1)))

    def choose(self, p, u2, n=None):
        """See `ByPower.choose`; n does not count."""
        index, probability = np.empty(p.shape[1], np.intp), np.empty_like(p[0])
        for part in parts(p.shape[1], self.table.power.size):
            weights = self._weights(p[:, part])
            index[part], probability[part], u2[0, part] = pick(weights, u2[0, part])
        return index, probability, u2

    def probability(self, index, p, n=None):
        """See `ByPower.probability`."""
        probability = np.empty_like(p[0])
        for part in parts(p.shape[1], self.table.power.size):
            probability[part] = share_of(self._weights(p[:, part]), index[part])
        return probability

    def _weights(self, p):
        weights, _ = weigh(self.table, p)
        # The one that outshines the others by far may be hidden from here: they must be found as well.
        return np.maximum(weights, np.float32(_LEAST) * weights.max(axis=0), out=weights)


def weight_table(lights, size2, shape):
    """The columns (M,) of `interfaces.Light.weight`, as `weigh` takes them: float32, of `shape`; size2 (M,) are squared radii."""
    table = {
        "centre": lights.centre,
        "power": lights.power / lights.power.max(),
        "radius2": lights.radius2 + np.finfo(np.float32).tiny,
        # What is the same everywhere is on all sides.
        "size": np.where(lights.nearness > 0, np.maximum(np.sqrt(size2), np.finfo(np.float32).tiny), _EVERYWHERE),
    }
    if (lights.nearness != 1).any():
        table["nearness"] = lights.nearness
    if (lights.cos_edge > -1).any():
        table |= {
            "axis": lights.axis,
            "cos_edge": lights.cos_edge,
            "sin_edge": np.sqrt(1 - lights.cos_edge**2),
        }
    return Columns(**{name: np.float32(column).reshape(*column.shape[:-1], *shape) for name, column in table.items()})


def weigh(k, p, n=None):
    """The weights (M, N) at points p (3, N), and the squared distances; k is a `weight_table`, (M, 1) or (M, N).

    power / (nearness d^2 + radius2), times _DARK where a light does not shine: where the angle from its axis is more
    than that of its edge and that under which its own size is seen together. Where n (3, N) is given, also times the
    cosine to it, of what the size allows: (d cos + size) / (d + size), at least _DARK.
    """
    away = p[:, None] - k.centre
    distance2 = dot(away, away)
    weights = (k.nearness * distance2 if hasattr(k, "nearness") else distance2) + k.radius2
    np.divide(k.power, weights, out=weights)
    if hasattr(k, "axis"):
        # Cosine and sine of both angles' sum, times the distance; the other leg of the triangle that size and distance make.
        leg = np.sqrt(np.maximum(distance2 - k.size * k.size, 0))
        is_lit = dot(away, k.axis) >= k.cos_edge * leg - k.sin_edge * k.size
        is_lit |= k.sin_edge * leg + k.cos_edge * k.size <= 0
        is_lit |= leg == 0
        # Not 0 in the dark: a light may leak over its edge, and all may be dark.
        weights *= np.float32(_DARK) + np.float32(1 - _DARK) * is_lit
    if n is not None:
        share = k.size - dot(away, n[:, None])
        share /= np.sqrt(distance2) + k.size
        weights *= np.maximum(share, np.float32(_DARK), out=share)
    return weights, distance2


def pick(weights, u1, known=None, way=None):
    """One of M weights (M, N) for each u1 (N,): indices (N,), their probabilities, and the places of u1 within them.

    For the lanes `known` (K,), if any, `way` (K,) are the indices, whatever u1 says, and the places mean nothing.
    """
    edges = _added_up(weights)
    place = u1 * edges[-1]
    index = (place >= edges[:-1]).view(np.int8).sum(axis=0, dtype=np.int8).astype(np.intp)
    if known is not None:
        index[known] = way
    weight = at(weights, index)
    place -= at(edges, index) - weight
    place /= weight
    return index, weight / edges[-1], np.clip(place, 0, np.float32(ONE_MINUS_EPS32), out=place)


def _added_up(weights):
    """Each of M weights (M, N) and all before it, (M, N). Row by row: `np.cumsum` goes through the lanes one by one."""
    sums = weights.copy()
    for below, row in pairwise(sums):
        row += below
    return sums


def share_of(weights, index):
    """The probability (N,) with which `pick` returns `index` (N,)."""
    # Not weights.sum(axis=0), which adds in another order where there is one lane, and so would depend on the tiles.
    return at(weights, index) / sum(weights[1:], weights[0])


def at(table, index):
    """table (M, N) at `index` (N,) of each lane."""
    return gather(table.reshape(-1), index * table.shape[1] + np.arange(table.shape[1]))


def parts(lanes, weights):
    """Slices of `lanes` for which so many `weights` each are held at a time."""
    step = max(1, _AT_ONCE // weights)
    return [slice(start, start + step) for start in range(0, lanes, step)]
