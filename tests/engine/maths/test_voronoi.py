"""Cells are those of scalar twins in float64, that look at more cells than they need; hashes as `test_cellhash` has them."""

import itertools
import math

import numpy as np
import pytest

from glanz.engine.maths import voronoi
from glanz.engine.maths.voronoi import FEATURES, METRICS, Shape, edge_distance, f1, fractal_cells, fractal_edges, sphere_radius
from glanz.tests import helpers as h
from glanz.tests.engine.maths.test_cellhash import twin_pcg, twin_unit
from glanz.tests.engine.maths.test_perlin import places

LENGTHS = {
    "euclidean": lambda d, e: math.sqrt(sum(x * x for x in d)),
    "manhattan": lambda d, e: sum(map(abs, d)),
    "chebychev": lambda d, e: max(map(abs, d)),
    "minkowski": lambda d, e: sum(abs(x) ** e for x in d) ** (1 / e),
}
RANDOMNESS = 0.8
each = pytest.mark.parametrize(("dimensions", "is_integer"), [*itertools.product((1, 2, 3, 4), (True, False))])


def twin_point(cell, is_integer):
    if len(cell) > 1 and is_integer:
        numbers = twin_pcg(*cell)
    elif len(cell) < 4:
        numbers = [twin_unit(*cell, *seed) for seed in ((), (1,), (2,))[: len(cell)]]
    else:
        numbers = [twin_unit(*cell[-k:], *cell[:-k]) for k in (4, 1, 2, 3)]
    return [c + RANDOMNESS * x for c, x in zip(cell, numbers)]


def around(p, is_integer, reach=1):
    """The points of all cells at most `reach` away from p."""
    cell = [math.floor(c) for c in p]
    for step in itertools.product(range(-reach, reach + 1), repeat=len(p)):
        yield twin_point([c + s for c, s in zip(cell, reversed(step))], is_integer)


def way(a, b):
    return [x - y for x, y in zip(a, b)]


def shape(is_integer, metric="euclidean", exponent=0.7, smoothness=0.25):
    return Shape(np.float32([RANDOMNESS]), metric, np.float32([exponent]), np.float32([smoothness]), is_integer)


def some(dimensions):
    p = places(40 if dimensions < 4 else 12, 8.0, dimensions)
    return p, [list(map(float, q)) for q in p.T]


@each
@pytest.mark.parametrize("metric", METRICS)
def test_the_nearest_points_are_those_of_the_twin(dimensions, is_integer, metric):
    p, points = some(dimensions)
    for feature, rank in (("f1", 0), ("f2", 1)):
        distance, colour, position = FEATURES[feature](p, shape(is_integer, metric))
        assert colour.shape == (3, p.shape[1])
        for i, q in enumerate(points):
            found = sorted((LENGTHS[metric](way(o, q), 0.7), o) for o in around(q, is_integer))[rank]
            assert distance[i] == pytest.approx(found[0], abs=2e-5, rel=2e-5)
            assert position[:, i] == pytest.approx(found[1], abs=2e-5)


def test_the_twin_catches_a_smaller_neighbourhood(monkeypatch):
    monkeypatch.setattr(voronoi, "_around", lambda dimensions: [np.zeros((dimensions, 1), np.int32)])
    with pytest.raises(AssertionError):
        test_the_nearest_points_are_those_of_the_twin(2, True, "euclidean")


@each
def test_smooth_cells_are_smooth_minima_over_all_cells(dimensions, is_integer):
    if dimensions == 4 and not is_integer:
        return
    p, points = some(dimensions)
    distance, _, _ = FEATURES["smooth f1"](p, shape(is_integer))
    for i, q in enumerate(points[:12]):
        total = None
        for o in around(q, is_integer, 2):
            d = LENGTHS["euclidean"](way(o, q), None)
            x = 1 if total is None else min(max(0.5 + 0.5 * (total - d) / 0.25, 0), 1)
            x = x * x * (3 - 2 * x)
            total = d if total is None else total + (d - total) * x - 0.25 * x * (1 - x)
        assert distance[i] == pytest.approx(total, abs=2e-5)


def test_without_smoothness_smooth_cells_are_sharp_lane_by_lane():
    p = places(500, 8.0)
    smoothness = np.where(np.arange(500) % 2, 0, np.float32(0.3)).astype(np.float32)
    mixed = FEATURES["smooth f1"](p, Shape(np.float32([1]), smoothness=smoothness))
    for found, expected in zip(mixed, f1(p, Shape(np.float32([1])))):
        assert np.abs(found - expected)[..., 1::2].max() <= 1e-6
        assert np.abs(found - expected)[..., ::2].max() > 0.01


@each
def test_edges_are_half_way_between_points(dimensions, is_integer):
    p, points = some(dimensions)
    found = edge_distance(p, shape(is_integer))
    for i, q in enumerate(points):
        others = [way(o, q) for o in around(q, is_integer)]
        near = min(others, key=lambda d: sum(x * x for x in d))
        if dimensions == 1:
            # Blender's own: between the point of this cell and those beside it.
            left, middle, right = (d[0] for d in others)
            assert found[i] == pytest.approx(min(abs((middle + left) / 2), abs((middle + right) / 2)), abs=2e-5)
            continue
        expected = math.inf
        for d in others:
            across = way(d, near)
            gap = sum(x * x for x in across)
            if gap > 1e-4:
                expected = min(expected, sum((x + y) / 2 * c for x, y, c in zip(near, d, across)) / math.sqrt(gap))
        assert found[i] == pytest.approx(expected, abs=5e-5)


@each
def test_spheres_reach_half_way_to_the_nearest_other_point(dimensions, is_integer):
    p, points = some(dimensions)
    found = sphere_radius(p, shape(is_integer))
    for i, q in enumerate(points):
        cells = {tuple(o): None for o in around(q, is_integer, 2)}
        near = min(around(q, is_integer), key=lambda o: sum(x * x for x in way(o, q)))
        gaps = sorted(LENGTHS["euclidean"](way(o, near), None) for o in cells)
        assert found[i] == pytest.approx(gaps[1] / 2, abs=5e-5)


def one(*values):
    return [np.float32([x]) for x in values]


def test_octaves_add_up():
    """Their distances and colours; positions are blended; normalised values are at most 1."""
    p = places(2000, 8.0)
    cells = shape(True)
    first, second = f1(p, cells), f1(p * np.float32(2), cells)
    distance, colour, position = fractal_cells(p, "f1", cells, *one(0.75, 0.5, 2), False)
    assert np.abs(distance - (first[0] + 0.375 * second[0])).max() <= 1e-5
    assert np.abs(colour - (first[1] + 0.375 * second[1])).max() <= 1e-5
    assert np.abs(position - (first[2] + 0.375 * (second[2] / 2 - first[2]))).max() <= 1e-5
    for feature in FEATURES:
        distance, colour, _ = fractal_cells(p, feature, cells, *one(1.5, 0.5, 2), True)
        assert distance.max() <= 1 and colour.max() <= 1
        assert distance.max() > 0.2


def test_edges_of_octaves_lie_within_each_other():
    p = places(2000, 8.0)
    cells = shape(True)
    first, second = edge_distance(p, cells), edge_distance(p * np.float32(2), cells) / 2
    found = fractal_edges(p, cells, *one(1, 1, 2), False)
    assert np.abs(found - np.minimum(first, second)).max() <= 1e-6
    assert fractal_edges(p, cells, *one(1.5, 0.7, 2), True).max() <= 1


def test_how_many_octaves_others_have_does_not_matter():
    p, detail = places(40, 8.0), np.linspace(0, 2, 40, dtype=np.float32)
    together = fractal_cells(p, "f1", shape(True), detail, *one(0.5, 2), True)
    for i in range(40):
        alone = fractal_cells(p[:, i : i + 1], "f1", shape(True), detail[i : i + 1], *one(0.5, 2), True)
        for a, b in zip(alone, together):
            assert h.same_bits(a[..., 0].copy(), b[..., i].copy())
