"""Which light a shadow ray is sent to: three ways, from none to choose from to many."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Columns, columns
from ..constants import ONE_MINUS_EPS32
from ..maths import discrete
from ..maths.vectors import dot

MOST_CLUSTERS = 32
"""Up to so many clusters of lights are weighed against each other at every point; each costs a few nanoseconds."""

_DARK = 2.0**-8
"""What a light weighs where it should not shine at all, compared to where it does."""

_LEAST = 2.0**-10
"""What the weakest cluster weighs at least, compared to the strongest."""


class OnlyLight:
    """There is one light: no choice, and no number spent."""

    def choose(self, p, u2):
        """See `ByPower.choose`; the index is None."""
        return None, 1.0, u2

    def probability(self, index, p):
        """See `ByPower.probability`."""
        return 1.0


@dataclass(frozen=True, slots=True, eq=False)
class ByPower:
    """In proportion to power, wherever it is needed. cdf (M,) float64, see `maths.discrete`."""

    cdf: np.ndarray
    lower: np.ndarray
    share: np.ndarray

    @classmethod
    def of(cls, powers):
        """From the power of each light (M,), any unit, not all 0."""
        cdf = discrete.cumulative(powers)
        share = discrete.probabilities(cdf)
        return cls(cdf, (cdf - share).astype(np.float32), share.astype(np.float32))

    def choose(self, p, u2):
        """A light for each point p (3, N): indices (N,), their probabilities (N,), and u2 (2, N) for the point on the light.

        The first of u2 chooses, and its place within the interval of the chosen light goes on as a number of its own
        (Shirley 1990): strata hold across the parts of a light. Of its 24 bits log2(M) are spent.
        """
        index = discrete.choose(self.cdf, u2[0])
        probability = self.share.take(index)
        stretched = u2[0] - self.lower.take(index)
        stretched /= probability
        np.clip(stretched, 0, np.float32(ONE_MINUS_EPS32), out=u2[0])
        return index, probability, u2

    def probability(self, index, p):
        """The probability (N,) with which `choose` at p (3, N) returns the lights `index` (N,)."""
        return self.share.take(index)


@dataclass(frozen=True, slots=True, eq=False)
class ByPlace:
    """In proportion to power over squared distance: first one of a few clusters, then by power within it.

    A cluster is a light object, or all that emits of one object. A sun weighs the same everywhere.

    by_power  the choice that ignores the place, over the same lights
    cluster   (M,) the cluster of each light, ascending from 0
    first     (C,) where each cluster begins in the cdf; total (C,) its share of it
    table     what the clusters weigh, see `interfaces.Light.weight`: (C, 1), vectors (3, C, 1)
    """

    by_power: ByPower
    cluster: np.ndarray
    first: np.ndarray
    total: np.ndarray
    table: Columns

    @classmethod
    def of(cls, by_power, clusters):
        """From the weight of each cluster, power a number, and its `count` of lights; in the order of the lights."""
        cluster = np.repeat(np.arange(len(clusters)), [c["count"] for c in clusters])
        edges = np.append(np.nonzero(np.diff(cluster, prepend=-1))[0], cluster.size)
        cdf = np.append(0.0, by_power.cdf)[edges]
        largest = max(c["power"] for c in clusters)
        table = columns([{**c, "power": c["power"] / largest} for c in clusters])
        del table.count
        table = Columns(**{name: column[..., None] for name, column in vars(table).items()})
        return cls(by_power, cluster, cdf[:-1].astype(np.float32), np.diff(cdf).astype(np.float32), table)

    def choose(self, p, u2):
        """See `ByPower.choose`."""
        weights = self._weights(p)
        edges = np.cumsum(weights, axis=0)
        place = u2[0] * edges[-1]
        chosen = np.zeros(place.shape, np.intp)
        for edge in edges[:-1]:
            chosen += place >= edge
        lane = np.arange(place.size)
        weight = weights[chosen, lane]
        # From the cluster's interval at this point to its interval in the cdf.
        place -= edges[chosen, lane] - weight
        place *= self.total.take(chosen) / weight
        place += self.first.take(chosen)
        np.clip(place, 0, np.float32(ONE_MINUS_EPS32), out=u2[0])
        index, _, u2 = self.by_power.choose(p, u2)
        return index, self._probability(index, weights, edges[-1]), u2

    def probability(self, index, p):
        """See `ByPower.probability`."""
        weights = self._weights(p)
        # Not weights.sum(axis=0), which adds in another order where there is one lane, and so would depend on the tiles.
        return self._probability(index, weights, sum(weights[1:], weights[0]))

    def _probability(self, index, weights, sum_of_weights):
        cluster = self.cluster.take(index)
        weight = weights[cluster, np.arange(weights.shape[1])]
        return weight / sum_of_weights * (self.by_power.share.take(index) / self.total.take(cluster))

    def _weights(self, p):
        k = self.table
        away = p[:, None] - k.centre
        distance2 = dot(away, away)
        weights = k.power / (k.nearness * distance2 + (k.radius2 + np.finfo(np.float32).tiny))
        # cos >= cos_edge with both squared, signs kept. Not 0 in the dark: a light may leak over its edge, and all may be dark.
        along = dot(away, k.axis)
        is_lit = along * np.abs(along) >= k.cos_edge * np.abs(k.cos_edge) * distance2
        weights *= np.float32(_DARK) + np.float32(1 - _DARK) * is_lit
        # The one that outshines the others by far may be hidden from here: they must be found as well.
        return np.maximum(weights, np.float32(_LEAST) * weights.max(axis=0))
