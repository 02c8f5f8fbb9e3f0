"""Hundreds and thousands of lights: the light of all of them, everywhere, without a sample that counts for too much (catalogue E12)."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, Lambert, Material, Mirror, Phong, PointLight, SpotLight
from glanz.engine.wavefront import direct, emission
from glanz.engine.wavefront.records import Rays
from glanz.engine.world import lamp_search, light_tree_choice
from glanz.engine.world.light_choice import weigh
from glanz.engine.world.light_tree_choice import ByTree
from glanz.engine.world.lights import Lights
from glanz.tests import chance, helpers as h
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
@chance.fresh
def test_a_thousand_bulbs_give_the_sum_of_their_closed_forms(point):
    """E1 a thousand times; detects 2 %."""
    check_bulbs(point)


@pytest.mark.parametrize(
    "mutant",
    [
        (ByTree, "_mixed", lambda self, place, node, share: np.float32(1.1) * mixed(self, place, node, share)),
        (light_tree_choice, "weigh", lambda k, p, n: (weigh(k, p + np.float32(300), n)[0], weigh(k, p, n)[1])),
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
    triangles = np.concatenate((np.stack((corner, corner + 1, corner + n + 2)), np.stack((corner, corner + n + 2, corner + n + 1))), axis=1)
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


def lamps_of_a_size(count):
    """Panels that face down, and bulbs, in rows above a floor; all are brighter than one another."""
    places = [(0.4 * (i % 8) - 1.4, 0.4 * (i // 8) - 1.2, 1.0 + 0.05 * (i % 3)) for i in range(count)]
    return [
        AreaLight(name=f"{i}", world_from_light=h.affine(translation=place), size_x=0.2, size_y=0.3, radiance=(1.0 + 0.1 * i,) * 3)
        if i % 2
        else PointLight(name=f"{i}", position=place, radius=0.1, intensity=(0.03 + 0.003 * i,) * 3)
        for i, place in enumerate(places)
    ]


def gallery(count, material, visible=False):
    floor = h.thing(h.quad(x=(6, 0, 0), y=(0, 6, 0)), material)
    lights = [h.replaced(lamp, is_visible=visible) for lamp in lamps_of_a_size(count)]
    return h.scene([floor], lights, camera=h.PerspectiveCamera.look_at((0.3, -3.5, 1.6), (0, 0, 0.3), fov=0.7))


@pytest.mark.parametrize("integrator", ["path", "path_blind", "whitted"])
def test_mirrors_and_cameras_show_as_many_lamps_as_there_are(monkeypatch, integrator):
    """48 lamps above a mirror: the picture in which each is asked one by one, bit for bit."""
    mirror = Material(name="mirror", lobes=(Mirror((0.9, 0.8, 0.7)),))
    settings = h.settings(width=48, height=48, max_depth=2, integrator=integrator)
    for visible in (True, False):
        image = h.pixels(gallery(48, mirror, visible), settings)
        with monkeypatch.context() as patch:
            patch.setattr(lamp_search, "MOST_ASKED", 1000)
            one_by_one = h.pixels(gallery(48, mirror, visible), settings)
        assert h.same_bits(image, one_by_one)
        assert np.unique(image.max(axis=0).round(3)).size > 40


def check_gloss(monkeypatch, exponent):
    material = Material(name="glossy", lobes=(Lambert((0.3,) * 3), Phong((0.6,) * 3, exponent)))
    settings = h.settings(width=16, height=16, samples=1024, max_depth=0)
    image = h.pixels(gallery(40, material), settings)[0].astype(float)
    with monkeypatch.context() as patch:
        patch.setattr(Lights, "rival", lambda self, index, pdf: pdf)
        patch.setattr(Lights, "looks_for_lamps", lambda self, pdf: None)
        shared = h.pixels(gallery(40, material), h.replaced(settings, seed=1))[0].astype(float)
    lit = shared > 0
    assert lit.sum() > 128
    assert h.mean_is(image[lit] / shared[lit], 1.0, floor=2e-3)


@pytest.mark.parametrize("exponent", [2.0, 8.0, 30.0, 3000.0])
def test_gloss_of_any_sharpness_shows_many_lamps(monkeypatch, exponent):
    """Sharp rays share the lamps with shadow rays, dull ones leave them to those: the picture in which all share all lamps.

    Exponents below and above where one becomes the other, and between them; detects 2 %.
    """
    check_gloss(monkeypatch, exponent)


@pytest.mark.parametrize(
    ("way", "mutant"), [("rival", lambda self, index, pdf: pdf), ("looks_for_lamps", lambda self, pdf: None)], ids=["dark", "twice"]
)
def test_gloss_catches_one_side_that_does_not_know_what_the_other_leaves(monkeypatch, way, mutant):
    with monkeypatch.context() as patch:
        patch.setattr(Lights, way, mutant)
        with pytest.raises(AssertionError):
            check_gloss(monkeypatch, 8.0)


def check_sides(monkeypatch):
    """A ball of 80 triangles that glow beside a tilted wall and floor: both ways together, and shadow rays alone."""
    ball = h.thing(h.icosphere(1, 0.5, (0, 0, 0.6)), h.lambert(0, "lamp", 2.0))
    walls = [h.thing(h.quad(x=(3, 0, 0), y=(0, 3, 0), name="floor")), h.thing(h.quad((0, 0.9, 0.5), (3, 0, 0), (0, 0.5, 2), name="wall"))]
    scene = h.scene([ball, *walls], camera=h.PerspectiveCamera.look_at((0.3, -3, 1.2), (0, 0, 0.5)))
    settings = h.settings(width=24, height=24, samples=256, max_depth=1)
    both = h.pixels(scene, settings)[0].astype(float)
    with monkeypatch.context() as patch:
        patch.setattr(direct, "power_heuristic", lambda pdf, other: np.float32(1))
        patch.setattr(emission, "power_heuristic", lambda pdf, other: np.float32(0))
        alone = h.pixels(scene, h.replaced(settings, seed=1))[0].astype(float)
    lit = (alone > 0) & (alone < 1)
    assert lit.sum() > 100
    assert h.mean_is(both[lit] / alone[lit], 1.0, floor=3e-3)


@chance.fresh
def test_rays_know_which_way_the_surface_faced_that_they_left(monkeypatch):
    """E14: weights sum to one also where the choice of a light depends on the side; detects 2 %."""
    plan = h.plan_of(gallery(40, h.lambert(0.5)), h.settings())
    assert direct.remember_side in plan.on_leaving
    assert h.plan_of(gallery(30, h.lambert(0.5)), h.settings()).on_leaving == ()
    check_sides(monkeypatch)


def test_sides_catch_rays_that_have_forgotten_them(monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(Rays, "facing", property(lambda self: -self.carried.facing))
        with pytest.raises(AssertionError):
            check_sides(monkeypatch)
