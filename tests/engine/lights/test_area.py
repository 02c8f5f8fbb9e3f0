"""Area lights and emissive polygons against Lambert's formula (catalogue E4, E5)."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, SceneError
from glanz.engine.lights import area as module
from glanz.engine.maths.vectors import dot
from glanz.tests import chance, helpers as h
from glanz.tests.polygons import polygon_irradiance

SQUARE = 0.752274688
"""E4: irradiance per radiance of a unit square, parallel, at distance 1, on its axis."""
OVERHEAD = h.affine(np.eye(3), (0, 0, 1))


def irradiances(light, normal=(0, 0, 1), p=(0, 0, 0), u2=None):
    """E cos [W m^-2] of each sample."""
    u2 = h.uniform(1, chance.times(100_000)) if u2 is None else u2
    wi, _, E, _ = light.sample(h.table(light.row(h.UNIT_FRAME)), np.repeat(np.array(p, float)[:, None], u2.shape[1], 1), u2)
    return E[0] * np.maximum(dot(h.unit(*normal), wi), 0)


def test_the_formula_for_polygons_gives_the_known_square():
    corners = [(-0.5, -0.5, 1), (0.5, -0.5, 1), (0.5, 0.5, 1), (-0.5, 0.5, 1)]
    assert polygon_irradiance(corners, (0, 0, 0), (0, 0, 1)) == pytest.approx(SQUARE, abs=1e-9)
    a = b = 0.5
    factor = (a / math.hypot(1, a) * math.atan(b / math.hypot(1, a)) + b / math.hypot(1, b) * math.atan(a / math.hypot(1, b))) / (
        2 * math.pi
    )
    assert 4 * factor * math.pi == pytest.approx(SQUARE, abs=1e-9)


@chance.fresh
def test_a_unit_square_gives_the_sum_of_four_corners():
    """E4; detects 0.1 % with 1e5 samples."""
    assert h.mean_is(irradiances(AreaLight(world_from_light=OVERHEAD)), SQUARE)


def test_the_square_catches_a_light_without_its_cosine_and_twice_the_light(monkeypatch):
    light = AreaLight(world_from_light=OVERHEAD)
    values = irradiances(light)
    assert not h.mean_is(2 * values, SQUARE)
    monkeypatch.setattr(module, "_radiance", lambda k, cos: k.radiance / cos)
    assert not h.mean_is(irradiances(light), SQUARE)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
@pytest.mark.parametrize("radiance", [1e-30, 1e30])
@chance.fresh
def test_a_unit_square_at_the_extremes(scale, radiance):
    """Irradiance does not depend on the scale of the scene, and is proportional to the radiance."""
    light = AreaLight(world_from_light=h.affine(scale * np.eye(3), (0, 0, scale)), radiance=(radiance,) * 3)
    assert h.mean_is(irradiances(light) / radiance, SQUARE)


def random_polygon(seed):
    """A convex polygon of 3 to 6 corners as (frame, corners in its plane), a point and a normal; all generic."""
    rng = np.random.default_rng(seed)
    turns = np.sort(rng.random(rng.integers(3, 7))) * 2 * np.pi
    radii = np.array([[math.cos(t), math.sin(t)] for t in turns]) * (0.5 + rng.random())
    frame = h.rotation(seed)
    centre = frame[:, 2] + 0.7 * rng.standard_normal(3)
    corners = centre + radii @ frame[:, :2].T
    normal = rng.standard_normal(3)
    return corners, rng.standard_normal(3) * 0.2, normal / np.linalg.norm(normal)


def polygon_world(corners):
    """The compiled world of an emissive fan of triangles with radiance 1."""
    mesh = h.Mesh(name="polygon", vertices=corners.T, triangles=np.array([(0, i, i + 1) for i in range(1, len(corners) - 1)]).T)
    camera = h.PerspectiveCamera.look_at(corners.mean(axis=0) + np.array((0, 0, 1)), corners.mean(axis=0), up=(1, 0.1, 0))
    return h.plan_of(h.scene([h.thing(mesh, h.lambert(0.5, emission=1.0))], camera=camera), h.settings()).world


def emitted_irradiances(world, p, normal, n=20_000, seed=1):
    """E cos of n samples of what emits in `world`: a light chosen, and a point on it."""
    there = world.frame.points(np.repeat(np.array(p, float)[:, None], n, 1)).astype(np.float32)
    index, probability, u2 = world.lights.choice.choose(there, h.uniform(seed, n, np.float32))
    wi, _, E, _ = world.lights.sample(index, there, u2)
    return E[0] / probability * np.maximum(normal @ wi.astype(float), 0)


@pytest.mark.parametrize("first", range(0, 50, 10))
@chance.fresh
def test_emissive_polygons_give_the_sum_over_their_edges(first):
    """E5: 50 random polygons and receivers, clipped at the horizon, 2e4 samples each; detects 2 % of one of them.

    Where only a corner of the polygon is above the horizon samples are too rare to judge: 1e-6 W m^-2 is forgiven.
    """
    for seed in range(first, first + 10):
        corners, p, normal = random_polygon(chance.seeded(seed))
        truth = polygon_irradiance(corners, p, normal)
        values = emitted_irradiances(polygon_world(corners), p, normal)
        assert h.mean_is(values, truth, floor=1e-5, absolute=1e-6), seed


@pytest.mark.parametrize("first", range(0, 50, 25))
@chance.fresh
def test_area_lights_give_the_sum_over_their_edges_on_the_side_they_face(first):
    """E5 for random rectangles, parallelograms included: one-sided."""
    for seed in range(first, first + 25):
        rng = np.random.default_rng(chance.seeded(1000 + seed))
        frame = h.rotation(seed) @ np.array([[1, 0.3, 0], [0, 1, 0], [0, 0, 1.0]])
        centre, p, normal = rng.standard_normal(3) * 1.5, rng.standard_normal(3) * 0.2, rng.standard_normal(3)
        light = AreaLight(world_from_light=h.affine(frame, centre), size_x=0.5 + rng.random(), size_y=0.5 + rng.random())
        x, y = frame[:, 0] * light.size_x / 2, frame[:, 1] * light.size_y / 2
        corners = [centre + sx * x + sy * y for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        faces = (p - centre) @ np.cross(x, y) < 0
        truth = polygon_irradiance(corners, p, normal / np.linalg.norm(normal)) if faces else 0.0
        assert h.mean_is(irradiances(light, normal, p, h.uniform(seed, chance.times(20_000))), truth, absolute=1e-6), seed


def test_the_polygon_formula_catches_one_percent_and_a_light_sampled_in_part(monkeypatch):
    corners, p, normal = np.array([(-0.5, -0.5, 1), (0.5, -0.5, 1), (0.5, 0.5, 1)]), np.zeros(3), np.array([0.6, 0, 0.8])
    world, truth = polygon_world(corners), polygon_irradiance(corners, p, normal)
    assert h.mean_is(emitted_irradiances(world, p, normal), truth, floor=1e-5)
    assert not h.mean_is(emitted_irradiances(world, p, normal, n=200_000), truth * 1.01, floor=1e-5)
    sample = type(world.lights).sample
    monkeypatch.setattr(type(world.lights), "sample", lambda self, index, p, u2, time=None: sample(self, index, p, u2 * np.float32(0.7)))
    assert not h.mean_is(emitted_irradiances(world, p, normal), truth, floor=1e-5)


def test_disks_and_ellipses():
    """E = pi L R^2 / (R^2 + h^2) on the axis of a disk; the area of an ellipse is pi / 4 of its rectangle's."""
    disk = AreaLight(world_from_light=OVERHEAD, size_x=2.0, size_y=2.0, is_ellipse=True)
    assert h.mean_is(irradiances(disk), math.pi / 2)
    ellipse = AreaLight(world_from_light=h.affine(np.diag((2.0, 1.0, 1.0)), (0, 0, 1)), size_x=1.0, size_y=3.0, is_ellipse=True)
    assert ellipse.area() == pytest.approx(math.pi / 4 * 2 * 3)
    assert ellipse.power() == pytest.approx((math.pi * ellipse.area(),) * 3)
    # Far away it is a point of intensity L A.
    far = AreaLight(world_from_light=h.affine(np.diag((2.0, 1.0, 1.0)), (0, 0, 1e3)), size_x=1.0, size_y=3.0, is_ellipse=True)
    assert irradiances(far).mean() == pytest.approx(ellipse.area() * 1e-6, rel=1e-5)


@pytest.mark.parametrize("spread", [math.radians(1), math.radians(60), math.radians(120), math.radians(179.9), math.pi])
def test_the_flux_does_not_depend_on_the_spread(spread):
    """Integral of L(theta) cos over the half space is pi L for each spread; by quadrature to 1e-9."""
    light = AreaLight(world_from_light=OVERHEAD, spread=spread)
    k = h.table(light.row(h.UNIT_FRAME))
    edge = math.cos(spread / 2)
    x, weight = np.polynomial.legendre.leggauss(400)
    # theta from 0 to spread / 2; the tangent's pole at 90 degrees is beyond, or not there
    theta = 0.25 * spread * (x + 1)
    d = np.stack((np.sin(theta), 0 * theta, np.cos(theta)))
    _, L, _ = light.hit(k, np.array([[0.0], [0.0], [1.0]]) - d, d)
    L = np.broadcast_to(L, d.shape)[0]
    flux = 2 * math.pi * (L * np.cos(theta) * np.sin(theta) * weight).sum() * 0.25 * spread
    assert flux == pytest.approx(math.pi, rel=1e-6)
    if spread < math.pi:
        beyond = h.at_angle(math.acos(edge) + 1e-6)
        assert np.broadcast_to(light.hit(k, np.array([[0.0], [0.0], [1.0]]) - beyond, beyond)[1], (3, 1))[0, 0] == 0


def test_a_narrow_spread_keeps_its_beam():
    """A point straight below sees the gain of the spread: tan a / (tan a - a)."""
    a = math.radians(30)
    light = AreaLight(world_from_light=OVERHEAD, size_x=1e-5, size_y=1e-5, spread=2 * a)
    assert irradiances(light).mean() * 1e10 == pytest.approx(math.tan(a) / (math.tan(a) - a), rel=1e-4)


def test_the_back_of_an_area_light_is_dark():
    light = AreaLight(world_from_light=OVERHEAD)
    assert irradiances(light, normal=(0, 0, -1), p=(0, 0, 2)).max() == 0
    assert irradiances(light, normal=(0, 0, 1), p=(0.1, 0, 1)).max() == 0  # in its own plane


def test_scale_makes_an_area_light_larger():
    light = AreaLight(world_from_light=h.affine(np.diag((3.0, 0.5, 9.0))), size_x=2.0, size_y=4.0)
    assert light.area() == pytest.approx(3 * 2 * 0.5 * 4)


def test_an_area_light_without_area_gives_nothing_and_no_nan():
    for light in (AreaLight(size_x=0.0), AreaLight(world_from_light=h.affine(np.zeros((3, 3)), (0, 0, 1)))):
        light.check()
        assert not light.has_extent()
        assert light.power() == (0, 0, 0)
        values = irradiances(light)
        assert (values == 0).all()


def test_a_bad_area_light_is_refused_by_name():
    for bad in ({"size_x": -1.0}, {"size_y": -1.0}, {"spread": 0.0}, {"spread": 3.2}):
        with pytest.raises(SceneError, match="light 'Panel'"):
            AreaLight(name="Panel", **bad).check()


@pytest.mark.parametrize("mirror", [1, -1])
@pytest.mark.parametrize("spread", [math.pi, 1.0])
def test_a_light_is_weighed_where_it_shines(mirror, spread):
    """The axis that lights are chosen by is a unit vector along which it shines, with its greatest intensity, mirrored or not."""
    matrix = h.affine(h.frame_towards((0.3, 0.1, 1.0)) @ np.diag((2.0 * mirror, 3.0, 0.5)))
    light = AreaLight(world_from_light=matrix, spread=spread)
    weight = light.weight(h.UNIT_FRAME)
    axis = np.array(weight["axis"])
    assert np.linalg.norm(axis) == pytest.approx(1)
    k = h.table(light.row(h.UNIT_FRAME))
    _, _, E, _ = light.sample(k, 1e3 * axis[:, None], np.array([[0.5], [0.5]]))
    assert 1e6 * E[0, 0] == pytest.approx(weight["power"][0], rel=1e-4)
    assert light.sample(k, -1e3 * axis[:, None], np.array([[0.5], [0.5]]))[2].max() == 0
    assert weight["cos_edge"] == pytest.approx(math.cos(spread / 2), abs=1e-12)
