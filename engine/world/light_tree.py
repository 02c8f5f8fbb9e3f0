"""A tree over thousands of lights: neighbours together, so that far away groups can be weighed as one.

After Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting" (Proceedings of the
ACM on Computer Graphics and Interactive Techniques 1(2)). Built level by level for all nodes at once.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Columns

FEWEST = 2.0**-30
"""The least power of a node, compared to the strongest light: its weight must not vanish in float32."""
_MOST_LEAVES = 2**16
"""Of more lights than this, the nearest to each other share a leaf."""


@dataclass(frozen=True, slots=True, eq=False)
class Tree:
    """A binary tree; the children of a node come after it, next to each other.

    order        (M,) the lights as they stand in the tree, each node's side by side
    first, last  (K,) which part of the order each node has
    left         (K,) its first child, or -1 for a leaf: a single light, or a few if there are very many
    levels       the slice of nodes of each level
    """

    order: np.ndarray
    first: np.ndarray
    last: np.ndarray
    left: np.ndarray
    levels: tuple

    @classmethod
    def of(cls, centre):
        """Over lights at `centre` (3, M): boxes are cut in the middle, at first; later where half of the lights are.

        Cutting in the middle tells apart what is far apart; but of lights that lie like 1, 1/2, 1/4, ... it would take one
        at a time.
        """
        count = centre.shape[1]
        patience, fewest = 1.5 * np.log2(count) + 4, 1 + count // _MOST_LEAVES
        order = np.arange(count)
        first, last, left, levels = [np.array([0])], [np.array([count])], [], []
        made = 0
        while True:
            starts, ends = first[-1], last[-1]
            levels.append(slice(made, made + starts.size))
            made += starts.size
            open_ = np.nonzero(ends - starts > fewest)[0]
            children = np.full(starts.size, -1)
            children[open_] = made + 2 * np.arange(open_.size)
            left.append(children)
            if not open_.size:
                break
            starts, ends = starts[open_], ends[open_]
            cut = starts + _divide(centre, order, starts, ends, is_even=len(levels) > patience)
            first.append(np.stack((starts, cut), axis=1).reshape(-1))
            last.append(np.stack((cut, ends), axis=1).reshape(-1))
        return cls(order, np.concatenate(first), np.concatenate(last), np.concatenate(left), tuple(levels))

    def gather(self, lights):
        """The columns of all nodes (K,) from those of the lights (M,), see `bounds`."""
        ordered = lights.take(self.order)
        nodes = Columns(**{name: np.zeros((*column.shape[:-1], self.first.size)) for name, column in vars(lights).items()})
        leaves = np.nonzero(self.left < 0)[0]
        united = ordered.take(self.first[leaves])
        for i in range(1, (self.last - self.first)[leaves].max()):
            more = np.nonzero(self.first[leaves] + i < self.last[leaves])[0]
            _put(united, more, _united(united.take(more), ordered.take(self.first[leaves[more]] + i)))
        _put(nodes, leaves, united)
        for level in reversed(self.levels):
            parents = level.start + np.nonzero(self.left[level] >= 0)[0]
            _put(nodes, parents, _united(nodes.take(self.left[parents]), nodes.take(self.left[parents] + 1)))
        return nodes


def _put(table, rows, values):
    for name, column in vars(table).items():
        column[..., rows] = getattr(values, name)


def _divide(centre, order, starts, ends, is_even):
    """Sort each part starts .. ends of `order` into two; how many the first half of each gets."""
    sizes = ends - starts
    begin = np.cumsum(sizes) - sizes
    part = np.repeat(np.arange(sizes.size), sizes)
    within = np.arange(sizes.sum()) - begin[part]
    place = starts[part] + within
    item = order[place]
    low, high = (f.reduceat(centre[:, item], begin, axis=1) for f in (np.minimum, np.maximum))
    axis = (high - low).argmax(axis=0)
    x = centre[axis[part], item]
    if is_even:
        item = item[np.lexsort((x, part))]
        is_right = within >= (sizes // 2)[part]
    else:
        middle = (0.5 * (low + high))[axis, np.arange(axis.size)]
        is_right = x > middle[part]
        # Where all are at one place, any half will do.
        right = np.add.reduceat(is_right.astype(np.intp), begin)
        is_stuck = ((right == 0) | (right == sizes))[part]
        is_right = np.where(is_stuck, within >= (sizes // 2)[part], is_right)
    left = sizes - np.add.reduceat(is_right.astype(np.intp), begin)
    rights = np.cumsum(is_right)
    rights -= (rights - is_right)[begin][part]
    order[np.where(is_right, place - within + left[part] + rights - 1, place - rights)] = item
    return left


def bounds(centre, power, radius2, nearness, axis, cos_edge):
    """What `Tree.gather` unites, a column for each light, float64: `interfaces.Light.weight` as boxes and cones.

    low, high    (3, M) box
    power        (M,) of all, at least FEWEST of the largest
    nearness     (M,) 1, or 0 for what is the same everywhere
    axis, angle  (3, M), (M,) the cone that holds all directions of light; pi for all directions, and then there is no axis
    is_alike     (M,) 1 where all lights shine all around, and so differ by power alone as seen from afar
    """
    angle = np.arccos(np.clip(cos_edge, -1, 1))
    size = np.sqrt(radius2 / 3) * (nearness > 0)
    return Columns(
        low=centre - size,
        high=centre + size,
        power=np.maximum(power / power.max(), FEWEST),
        nearness=nearness,
        axis=axis * (angle < np.pi),
        angle=angle,
        is_alike=(angle == np.pi).astype(float),
    )


def _united(a, b):
    axis = a.axis + b.axis
    length = np.sqrt((axis * axis).sum(axis=0))
    axis = axis / np.where(length > 0, length, 1)
    angle = np.maximum(*(np.arccos(np.clip((axis * c.axis).sum(axis=0), -1, 1)) + c.angle for c in (a, b)))
    is_beam = (angle < np.pi) & (length > 0)
    return Columns(
        low=np.minimum(a.low, b.low),
        high=np.maximum(a.high, b.high),
        power=a.power + b.power,
        nearness=np.maximum(a.nearness, b.nearness),
        axis=axis * is_beam,
        angle=np.where(is_beam, angle, np.pi),
        is_alike=a.is_alike * b.is_alike,
    )
