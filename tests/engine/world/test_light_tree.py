"""The tree over many lights: every light once, bounds that hold, depth that stays low."""

import numpy as np
import pytest

from glanz.engine.arrays import Columns
from glanz.engine.world import light_tree
from glanz.engine.world.light_tree import FEWEST, Tree, bounds
from glanz.tests import helpers as h

RANDOM = np.random.default_rng(1)
CLOUDS = {
    "two": RANDOM.random((3, 2)),
    "random": RANDOM.random((3, 1000)),
    "at one place": np.ones((3, 100)),
    "on a line": RANDOM.random((3, 300)) * [[1], [0], [0]],
    "gathering": np.stack((2.0 ** -np.arange(600), np.zeros(600), np.zeros(600))),
    "two crowds": np.concatenate((RANDOM.random((3, 100)), RANDOM.random((3, 100)) + 1e6), axis=1),
}


@pytest.mark.parametrize("name", CLOUDS)
def test_every_node_is_the_union_of_its_children(name):
    centre = CLOUDS[name]
    count = centre.shape[1]
    tree = Tree.of(centre)
    assert np.sort(tree.order).tolist() == list(range(count))
    assert (tree.first[0], tree.last[0]) == (0, count)
    inner = np.nonzero(tree.left >= 0)[0]
    a, b = tree.left[inner], tree.left[inner] + 1
    assert (tree.first[a] == tree.first[inner]).all()
    assert (tree.last[a] == tree.first[b]).all()
    assert (tree.last[b] == tree.last[inner]).all()
    assert (tree.last > tree.first).all()
    assert (tree.last - tree.first)[tree.left < 0].max() == 1
    assert len(tree.levels) <= 2.5 * np.log2(count) + 7


def test_what_is_far_apart_is_told_apart_first():
    tree = Tree.of(CLOUDS["two crowds"])
    assert tree.last[1] - tree.first[1] == 100


def test_of_very_many_lights_neighbours_share_a_leaf(monkeypatch):
    monkeypatch.setattr(light_tree, "_MOST_LEAVES", 100)
    centre = CLOUDS["random"]
    tree = Tree.of(centre)
    sizes = (tree.last - tree.first)[tree.left < 0]
    assert sizes.max() <= 11
    assert sizes.sum() == 1000
    check_bounds(tree, lights(centre))


def lights(centre, cos_edge=-1.0):
    count = centre.shape[1]
    return Columns(
        centre=centre,
        power=RANDOM.random(count),
        nearness=np.ones(count),
        radius2=0.01 * RANDOM.random(count),
        axis=h.directions(3, count) * [[0.2], [0.2], [1]] if cos_edge >= 0 else np.zeros((3, count)),
        cos_edge=np.full(count, cos_edge),
    )


def check_bounds(tree, table):
    table.axis /= np.maximum(np.linalg.norm(table.axis, axis=0), 1e-30)
    given = bounds(**vars(table))
    nodes = tree.gather(given)
    for node in range(0, tree.first.size, 7):
        items = tree.order[tree.first[node] : tree.last[node]]
        np.testing.assert_allclose(nodes.low[:, node], given.low[:, items].min(axis=1))
        np.testing.assert_allclose(nodes.high[:, node], given.high[:, items].max(axis=1))
        np.testing.assert_allclose(nodes.power[node], given.power[items].sum())
        # No light shines where its group does not.
        if nodes.angle[node] < np.pi:
            apart = np.arccos(np.clip(nodes.axis[:, node] @ given.axis[:, items], -1, 1))
            assert (apart + given.angle[items] <= nodes.angle[node] + 1e-6).all()
        assert nodes.is_alike[node] == given.is_alike[items].min()


@pytest.mark.parametrize("cos_edge", [-1.0, 0.95, 0.2])
def test_boxes_and_cones_hold_what_is_in_them(cos_edge):
    centre = CLOUDS["random"]
    check_bounds(Tree.of(centre), lights(centre, cos_edge))


def test_holding_catches_a_cone_that_is_too_narrow(monkeypatch):
    united = light_tree._united
    monkeypatch.setattr(light_tree, "_united", lambda a, b: Columns(**{**vars(united(a, b)), "angle": np.maximum(a.angle, b.angle)}))
    centre = CLOUDS["random"]
    with pytest.raises(AssertionError):
        check_bounds(Tree.of(centre), lights(centre, 0.95))


def test_the_weakest_keep_some_weight():
    table = lights(CLOUDS["two"])
    table.power[:] = 1e-30, 1e30
    assert bounds(**vars(table)).power.tolist() == [FEWEST, 1]
