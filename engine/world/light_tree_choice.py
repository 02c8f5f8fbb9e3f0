"""Which of thousands of lights a shadow ray is sent to: down a tree, from groups to single lights."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Columns, gather
from ..constants import ONE_MINUS_EPS32
from ..maths import discrete
from .light_choice import ByPower, at, parts, pick, share_of, weigh, weight_table
from .light_tree import Tree, bounds

WIDTH = 4
"""Children of a node that are weighed against each other."""
_TOP = 8
"""Nodes that are weighed at every point, before any is gone down into."""
_BY_POWER = 2.0**-3
"""The share of choices that ignore the place: lights that are near may be hidden, and a guess by boxes may be wrong. The
error is that of a choice by power with so much fewer samples at most."""
_AFAR = 3.0
"""Lights that are alike are chosen by power where their group is so many of its radii away: they differ by at most
(1 + 1/3)^2 / (1 - 1/3)^2 = 4 there, and mostly by far less."""
_SPREAD = 0.125
"""Mean squared distance of lights from the middle of their group, in units of its squared radius: a half to a third of
it where they fill a square or a cube, but what counts are those that are nearest."""


@dataclass(frozen=True, slots=True, eq=False)
class ByTree:
    """In proportion to power over squared distance, as far as groups show it.

    by_power        the choice that ignores the place, over the lights in the order of the tree
    guide           of that distribution
    order, rank     (M,) the light at each place of the order, and the place of each light
    top             what the nodes weigh that are weighed first, see `light_choice.weigh`: (C, 1)
    top_nodes       (C,) these nodes
    table           the same for children that are weighed against each other: (WIDTH, R), one row for each node that has any
    children        (WIDTH, R) these nodes; the missing ones stand first, and weigh 0
    row             (K,) the row of each node
    reach2          (K,) the squared distance from which on a node is not gone down into; 0 for leaves
    low, total      (K,) float64: where the lights of a node begin in the distribution by power, and their share of it
    first_choice    (M,) which of the top each light is under
    trail           (M,) int64: which child leads to it from there, two bits for each level, the first one lowest
    """

    minds_side = True

    by_power: ByPower
    guide: discrete.Guide
    order: np.ndarray
    rank: np.ndarray
    top: Columns
    top_nodes: np.ndarray
    table: Columns
    children: np.ndarray
    row: np.ndarray
    reach2: np.ndarray
    low: np.ndarray
    total: np.ndarray
    first_choice: np.ndarray
    trail: np.ndarray

    @classmethod
    def of(cls, powers, lights):
        """From the power of each light (M,), any unit, and `interfaces.Light.weight` as columns (M,) float64, power a number."""
        tree = Tree.of(np.where(lights.nearness > 0, lights.centre, 0))
        nodes = tree.gather(bounds(**vars(lights)))
        size2 = 0.25 * ((nodes.high - nodes.low) ** 2).sum(axis=0)
        by_power = ByPower.of(powers[tree.order])
        low = np.append(0.0, by_power.cdf)[tree.first]
        is_leaf, is_single = tree.left < 0, tree.last - tree.first == 1
        top_nodes = _top(tree, nodes.power * np.sqrt(size2))
        children, row, first_choice, trail = _wide(tree, top_nodes)
        weights = Columns(
            centre=0.5 * (nodes.low + nodes.high),
            power=nodes.power,
            nearness=nodes.nearness,
            # Something that is the same everywhere has no size.
            radius2=np.where(nodes.nearness > 0, np.where(is_single, 1, _SPREAD) * size2, 1.0),
            axis=nodes.axis,
            cos_edge=np.where(nodes.angle < np.pi, np.cos(nodes.angle), -1),
        )
        everything = weight_table(weights, size2, (-1,))
        table = everything.take(children)
        table.power[children < 0] = 0
        reach2 = np.where(nodes.is_alike > 0, _AFAR**2 * size2, np.inf)
        reach2[is_leaf] = 0
        return cls(
            by_power=by_power,
            guide=discrete.Guide.of(by_power.cdf),
            order=tree.order,
            rank=np.argsort(tree.order),
            top=Columns(**{name: column[..., None] for name, column in vars(everything.take(top_nodes)).items()}),
            top_nodes=top_nodes,
            table=table,
            children=children,
            row=row,
            reach2=reach2.astype(np.float32),
            low=low,
            total=by_power.cdf[tree.last - 1] - low,
            first_choice=first_choice,
            trail=trail,
        )

    def choose(self, p, u2, n=None):
        """See `ByPower.choose`."""
        index, probability = np.empty(p.shape[1], np.intp), np.empty_like(p[0])
        for part in parts(p.shape[1], _TOP):
            facing = None if n is None else n[:, part]
            index[part], probability[part], u2[0, part] = self._choose(p[:, part], u2[0, part], facing)
        return index, probability, u2

    def probability(self, index, p, n=None):
        """See `ByPower.probability`."""
        probability = np.empty_like(p[0])
        for part in parts(p.shape[1], _TOP):
            place = gather(self.rank, index[part])
            facing = None if n is None else n[:, part]
            node, share, _ = self._descend(p[:, part], np.zeros_like(p[0, part]), place, facing)
            probability[part] = self._mixed(place, node, share)
        return probability

    def _choose(self, p, u1, n):
        blind = np.nonzero(u1 < _BY_POWER)[0]
        place = np.full(u1.size, -1)
        u = (u1 - np.float32(_BY_POWER)) * np.float32(1 / (1 - _BY_POWER))
        blind_u = gather(u1, blind) * np.float32(1 / _BY_POWER)
        place[blind] = self.guide.choose(blind_u)
        node, share, u = self._descend(p, u, place, n)
        # Within the node by power, in float64: single lights may have the last few bits of the distribution.
        u = gather(self.low, node) + u * gather(self.total, node)
        u[blind] = blind_u
        found = self.guide.choose(u)
        found[blind] = gather(place, blind)
        u -= gather(self.by_power.lower, found)
        u /= gather(self.by_power.share, found)
        return gather(self.order, found), self._mixed(found, node, share), np.clip(u, 0, ONE_MINUS_EPS32)

    def _mixed(self, place, node, share):
        """The probability of the lights at `place` of the order, below a `node` that is chosen with probability `share`."""
        by_power = gather(self.by_power.share, place)
        by_place = share * (by_power / gather(self.total, node).astype(np.float32))
        return np.float32(_BY_POWER) * by_power + np.float32(1 - _BY_POWER) * by_place

    def _descend(self, p, u, place, n):
        """The last node (N,), its probability and what is left of u (N,): towards the lights at `place` (N,), -1: as u chooses."""
        weights, distance2 = weigh(self.top, p, n)
        chosen, probability, u = _follow(weights, u, place, gather(self.first_choice, place))
        node = gather(self.top_nodes, chosen)
        lanes = np.nonzero(at(distance2, chosen) < gather(self.reach2, node))[0]
        level = 0
        while lanes.size:
            row = gather(self.row, gather(node, lanes))
            facing = None if n is None else gather(n, lanes)
            weights, distance2 = weigh(self.table.take(row), gather(p, lanes), facing)
            towards = gather(place, lanes)
            chosen, share, u[lanes] = _follow(weights, gather(u, lanes), towards, (gather(self.trail, towards) >> level) & (WIDTH - 1))
            probability[lanes] *= share
            node[lanes] = deeper = gather(self.children.reshape(-1), chosen * self.children.shape[1] + row)
            lanes = lanes[at(distance2, chosen) < gather(self.reach2, deeper)]
            level += 2
        return node, probability, u


def _follow(weights, u, place, way):
    """`pick`, but where `place` (N,) is known `way` (N,) leads there."""
    known = np.nonzero(place >= 0)[0]
    if known.size == place.size:
        return way, share_of(weights, way), u
    return pick(weights, u, known, gather(way, known))


def _top(tree, size):
    """Up to _TOP nodes (C,) that hold all lights: the largest are replaced by their children."""
    nodes = [0]
    while len(nodes) < _TOP and (inner := [node for node in nodes if tree.left[node] >= 0]):
        largest = max(inner, key=lambda node: size[node])
        nodes.remove(largest)
        nodes += [tree.left[largest], tree.left[largest] + 1]
    return np.array(nodes)


def _wide(tree, top):
    """`children`, `row`, `first_choice` and `trail` of a `ByTree`, from the binary tree by leaving out every other level."""
    row = np.full(tree.first.size, -1)
    first_choice, trail = (np.zeros(tree.order.size, np.int64) for _ in range(2))
    for i, node in enumerate(top):
        first_choice[tree.first[node] : tree.last[node]] = i
    columns, count, level = [], 0, 0
    nodes = top[tree.left[top] >= 0]
    while nodes.size:
        row[nodes] = count + np.arange(nodes.size)
        count += nodes.size
        halves = (tree.left[nodes], tree.left[nodes] + 1)
        quarters = [np.where(tree.left[half] >= 0, tree.left[half] + i, half if i else -1) for half in halves for i in (0, 1)]
        columns.append(np.stack(quarters))
        for way, child in enumerate(quarters):
            child = child[child >= 0]
            sizes = tree.last[child] - tree.first[child]
            begin = np.repeat(tree.first[child] - (np.cumsum(sizes) - sizes), sizes)
            trail[begin + np.arange(sizes.sum())] |= way << level
        nodes = np.concatenate(quarters)
        nodes = nodes[(nodes >= 0) & (tree.left[nodes] >= 0)]
        level += 2
    children = np.concatenate(columns, axis=1) if columns else np.zeros((WIDTH, 0), np.intp)
    return children, row, first_choice, trail
