"""Point and spot lights against closed forms (catalogue E1, E2)."""

import math

import numpy as np
import pytest

from glanz.engine import PointLight, SceneError, SpotLight
from glanz.engine.lights import spot
from glanz.engine.lights.spot import falloff
from glanz.engine.maths.vectors import dot
from glanz.tests import chance, helpers as h

ORIGIN = np.zeros((3, 1))


def irradiance(light, normal, u2=None, p=ORIGIN, dtype=np.float64):
    """E [W m^-2] at p from each sample, first channel."""
    u2 = np.full((2, 1), 0.5) if u2 is None else u2
    wi, _, E, _ = light.sample(h.table(light.row(h.UNIT_FRAME), dtype), np.repeat(p, u2.shape[1], 1).astype(dtype), u2.astype(dtype))
    return E[0] * np.maximum(dot(normal.astype(dtype), wi), 0)


def test_a_point_light_falls_with_the_square_of_the_distance():
    """E1: k_d / pi I cos / d^2 = 1.989436789 for k_d = 0.5, I = 100, 60 degrees, d = 2."""
    light = PointLight(position=tuple(2 * h.at_angle(math.radians(60)).ravel()), intensity=(100.0,) * 3)
    assert 0.5 / math.pi * irradiance(light, h.unit(0, 0, 1))[0] == pytest.approx(1.989436789, rel=1e-9)
    assert irradiance(light, h.unit(0, 0, 1))[0] == pytest.approx(100 * 0.5 / 4, rel=1e-12)


@pytest.mark.parametrize("power", [1e-30, 1.0, 1e30])
@pytest.mark.parametrize("distance", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("grazing", [1e-3, 1e-5, 1e-7])
def test_a_point_light_has_its_digits_at_the_extremes(power, distance, grazing):
    wi = h.at_angle(math.pi / 2 - grazing)
    light = PointLight(position=tuple(distance * wi.ravel()), intensity=(power,) * 3)
    truth = power * math.sin(grazing) / distance**2
    # Directions are rounded: a cosine of 1e-7 is known to a few 1e-16 / 1e-7 at best, in float32 not at all.
    assert irradiance(light, h.unit(0, 0, 1))[0] == pytest.approx(truth, rel=1e-12 + 1e-15 / grazing)
    if power / distance**2 < 1e38:
        assert irradiance(light, h.unit(0, 0, 1), dtype=np.float32)[0] == pytest.approx(truth, rel=1e-6 + 2e-7 / grazing)


@pytest.mark.parametrize("radius", [1e-6, 0.5, 3.0])
def test_a_soft_bulb_gives_its_intensity_over_distance_and_radius_squared(radius):
    """E = I / (d^2 + r^2) facing the light: the disk's own closed form; detects 0.1 %."""
    light = PointLight(position=(0.0, 0.0, 2.0), intensity=(7.0,) * 3, radius=radius)
    assert irradiance(light, h.unit(0, 0, 1), h.stratified(1, 200)).mean() == pytest.approx(7 / (4 + radius**2), rel=1e-3)


@pytest.mark.parametrize("radius", [1e-6, 0.5, 1.9])
def test_a_ball_gives_its_intensity_over_distance_squared(radius):
    """E = I / d^2 facing the light, and I cos / d^2 tilted, as long as all of the ball is above the horizon."""
    light = PointLight(position=(0.0, 0.0, 2.0), intensity=(7.0,) * 3, radius=radius, soft_falloff=False)
    assert irradiance(light, h.unit(0, 0, 1), h.stratified(2, 200)).mean() == pytest.approx(7 / 4, rel=1e-3)
    if radius < 1:
        assert irradiance(light, h.at_angle(0.9), h.stratified(3, 200)).mean() == pytest.approx(7 / 4 * math.cos(0.9), rel=1e-3)


def test_the_inside_of_a_ball_is_lit_from_everywhere():
    """E = pi L = I / r^2 anywhere inside, whichever way the surface faces."""
    light = PointLight(position=(0.3, 0.0, 0.2), intensity=(7.0,) * 3, radius=2.0, soft_falloff=False)
    for seed in range(3):
        assert irradiance(light, h.directions(seed, 1), h.stratified(seed, 300)).mean() == pytest.approx(7 / 4, rel=5e-3)


def test_a_bulb_passes_into_a_point_as_it_shrinks():
    for soft in (True, False):
        for radius in (0.0, 1e-30, 1e-12):
            light = PointLight(position=(0.0, 1.0, 2.0), intensity=(7.0,) * 3, radius=radius, soft_falloff=soft)
            assert irradiance(light, h.unit(0, 1, 2))[0] == pytest.approx(7 / 5, rel=1e-12)


def blender_smoothstep(angle, blend, theta):
    """Blender's spot: smoothstep over (cos theta - cos(angle / 2)) / ((1 - cos(angle / 2)) blend), in plain numbers."""
    edge = math.cos(angle / 2)
    if blend == 0:
        return float(math.cos(theta) > edge)
    x = min(max((math.cos(theta) - edge) / ((1 - edge) * blend), 0.0), 1.0)
    return x * x * (3 - 2 * x)


@pytest.mark.parametrize("blend", [0.0, 0.15, 1.0])
@pytest.mark.parametrize("angle", [math.radians(1), math.radians(45), math.pi])
def test_a_spot_fades_by_the_formula_of_blender(angle, blend):
    """E2: at 101 angles across the cone and beyond, to 1e-9 of the intensity."""
    turn = h.rotation(7)
    light = SpotLight(world_from_light=h.affine(turn, 2 * turn[:, 2]), intensity=(9.0,) * 3, angle=angle, blend=blend)
    for theta in np.linspace(0, min(angle, math.pi / 2 * 0.999), 101) + 1e-6:
        # A point at `theta` from the axis -z of the light, at distance 2 of it.
        p = (2 * turn[:, 2:]) + 2 * turn @ np.array([[math.sin(theta)], [0], [-math.cos(theta)]])
        towards = -turn @ np.array([[math.sin(theta)], [0], [-math.cos(theta)]])
        assert irradiance(light, towards, p=p)[0] == pytest.approx(9 / 4 * blender_smoothstep(angle, blend, theta), abs=1e-9)


def test_the_formula_catches_a_spot_that_fades_linearly(monkeypatch):
    light = SpotLight(world_from_light=h.affine(np.eye(3), (0, 0, 2)), intensity=(9.0,) * 3, angle=1.0, blend=0.5)
    p = np.array([[math.tan(0.45) * 2], [0], [0]])
    truth = 9 / (4 + p[0, 0] ** 2) * blender_smoothstep(1.0, 0.5, 0.45)
    towards = h.unit(-p[0, 0], 0, 2)
    assert irradiance(light, towards, p=p)[0] == pytest.approx(truth, rel=1e-9)
    monkeypatch.setattr(spot, "falloff", lambda k, wi: np.clip((wi[2] - k.cos_edge) / k.fade, 0, 1))
    assert irradiance(light, towards, p=p)[0] != pytest.approx(truth, rel=1e-2)


@chance.fresh
def test_the_flux_through_a_hard_cone_is_its_solid_angle_times_the_intensity():
    """2 pi (1 - cos(22.5 degrees)) = 0.478279 for I = 1, by counting directions; detects a cone of 46 degrees."""
    light = SpotLight(angle=math.radians(45), blend=0.0)
    assert light.power()[0] == pytest.approx(0.478279, abs=1e-6)
    d = h.directions(1, 1_000_000)
    k = h.table(light.row(h.UNIT_FRAME))
    assert h.mean_is(falloff(k, -d) * 4 * np.pi, 0.478279)
    assert not h.mean_is(falloff(h.table(h.replaced(light, angle=math.radians(46)).row(h.UNIT_FRAME)), -d) * 4 * np.pi, 0.478279)


def test_a_stretched_spot_has_an_elliptic_cone():
    """The scale of the transform stretches the cone, as Blender does: twice as wide along x."""
    light = SpotLight(world_from_light=h.affine(np.diag((2.0, 1.0, 1.0))), angle=math.radians(60), blend=0.0)
    k = h.table(light.row(h.UNIT_FRAME))
    edge = math.tan(math.radians(30))
    for x, y, inside in ((1.99, 0, 1), (2.01, 0, 0), (0, 0.99, 1), (0, 1.01, 0)):
        assert falloff(k, h.unit(-x * edge, -y * edge, 1))[0] == inside


def test_bad_bulbs_and_cones_are_refused_by_name():
    with pytest.raises(SceneError, match=r"light 'Lamp': radius is -1\.0 m"):
        PointLight(name="Lamp", radius=-1.0).check()
    for bad in ({"angle": 0.0}, {"angle": 3.2}, {"blend": -0.1}, {"blend": 1.1}):
        with pytest.raises(SceneError, match="light 'Cone'"):
            SpotLight(name="Cone", **bad).check()
    with pytest.raises(SceneError, match="light 'Cone': radius"):
        SpotLight(name="Cone", radius=-2.0).check()
