"""Hundreds and thousands of lights: the light of all of them, everywhere, without a sample that counts for too much (catalogue E12)."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, PointLight, SpotLight
from glanz.engine.world import light_tree_choice
from glanz.engine.world.light_choice import weigh
from glanz.engine.world.light_tree_choice import ByTree
from glanz.tests import helpers as h
from glanz.tests.polygons import polygon_irradiance

mixed = ByTree._mixed
POINTS = ((0.0, 0.0, 0.0), (1.2, -0.7, 0.3), (-1.9, 1.9, 0.0), (6.0, 5.0, 0.0))


def bulbs(count=1000):
    rng = np.random.default_rng(1)
    places = np.stack((rng.uniform(-2, 2, count), rng.uniform(-2, 2, count), rng.uniform(0.5, 1.5, count)))
    powers = rng.choice((0.01, 1.0, 5.0), count)
    lights = [PointLight(name=f"{i}", position=tuple(places[:, i]), intensity=(powers[i],) * 3) for i in range(count)]
    return places, powers, lights


def irradiances(scene, samples=256):
    return h.pixels(scene, h.settings(samples=samples, max_depth=0))[0].reshape(-1).astype(np.float64) * math.pi


def check_bulbs(*points):
    for point in points:
        check_bulbs_at(point)


def check_bulbs_at(point):
    places, powers, lights = bulbs()
    away = places - np.array(point)[:, None]
    distance2 = (away**2).sum(axis=0)
    truth = (powers * np.maximum(away[2], 0) / distance2**1.5).sum()
    values = irradiances(h.receiver(lights, point=point, distance=0.01, size=0.001))
    assert h.mean_is(values, truth, floor=1e-4)
    # Of 256 samples each: a tenth at most, where a choice by power has a quarter.
    assert values.std() <= 0.1 * truth


@pytest.mark.parametrize("point", POINTS, ids=str)
def test_a_thousand_bulbs_give_the_sum_of_their_closed_forms(point):
    """E1 a thousand times; detects 2 %."""
    check_bulbs(point)


@pytest.mark.parametrize(
    "mutant",
    [
        (ByTree, "_mixed", lambda self, place, node, share: np.float32(1.1) * mixed(self, place, node, share)),
        (light_tree_choice, "weigh", lambda k, p: (weigh(k, p + np.float32(300))[0], weigh(k, p)[1])),
    ],
    ids=["a tenth too probable", "weighed for another place"],
)
def test_the_sum_catches_a_broken_choice(monkeypatch, mutant):
    monkeypatch.setattr(*mutant)
    with pytest.raises(AssertionError):
        check_bulbs(*POINTS)


def test_a_mesh_of_ten_thousand_triangles_does_not_collapse_close_to_it():
    """A square of 2 x 72 x 72 triangles 2 cm above a point: nearly half of the sky, pi L; noise stays that of one square.

    By power a sample near its foot would be one of ten thousand. Detects 1 %.
    """
    n, side = 72, np.linspace(-0.5, 0.5, 73)
    x, y = np.meshgrid(side, side)
    corner = (np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1]).ravel()
    triangles = np.concatenate(
        (np.stack((corner, corner + 1, corner + n + 2)), np.stack((corner, corner + n + 2, corner + n + 1))), axis=1
    )
    # Bent a little, or pairs of triangles would be squares.
    vertices = np.stack((x, y, 0.02 + 1e-4 * np.sin(9 * x) * np.cos(7 * y))).reshape(3, -1)
    lamp = h.thing(h.Mesh(name="lamp", vertices=vertices, triangles=triangles), h.lambert(0, "lamp", 1.0))
    scene = h.receiver(objects=[lamp], distance=0.005, size=0.0005)
    plan = h.plan_of(scene, h.settings())
    assert plan.world.emitters.count > 10_000
    corners = [(a, b, 0.02) for a, b in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))]
    truth = polygon_irradiance(corners, (0, 0, 0), (0, 0, 1))
    values = irradiances(scene)
    assert h.mean_is(values, truth, floor=2e-3)
    assert values.std() <= 0.05 * truth


def test_light_that_many_lamps_leave_dark_is_found_where_it_is():
    """Spots and panels that all look away but for a few: what those few give, with little noise."""
    rng = np.random.default_rng(3)
    up = np.diag((1.0, -1, -1))
    places = np.stack((rng.uniform(-2, 2, 200), rng.uniform(-2, 2, 200), rng.uniform(0.5, 1.5, 200))).T
    lights = [SpotLight(name=f"{i}", world_from_light=h.affine(up, place), angle=1.0) for i, place in enumerate(places)]
    lights += [AreaLight(name=f"p{i}", world_from_light=h.affine(up, place), size_x=0.1, size_y=0.1) for i, place in enumerate(places)]
    lights += [SpotLight(name="down", world_from_light=h.affine(translation=(0, 0, 2)), angle=1.0, blend=0.0)]
    values = irradiances(h.receiver(lights, distance=0.1))
    assert h.mean_is(values, 0.25, floor=1e-4)
    assert values.std() <= 0.3 * 0.25
