"""Lights that shine through textures: closed forms, and one radiance for shadow rays and for rays that meet the light."""

import math

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    BumpMap,
    CheckerTexture,
    Coordinates,
    Geometry,
    LightFalloff,
    LightPath,
    LinearTexture,
    NoiseTexture,
    ObjectValue,
    PointLight,
    SceneError,
    Separate,
    Shade,
    SpotLight,
    SunLight,
    VectorMath,
)
from glanz.engine.lights import area
from glanz.engine.registry import TEXTURES
from glanz.engine.scene.validate import validate
from glanz.engine.world.shades import share_left
from glanz.tests import helpers as h

TURNED = h.affine(h.rotation(4), (0.3, -0.2, 0.9))
OBJECT, UV, POSITION = Coordinates(source="object"), Coordinates(), Coordinates(source="position")
UV_COLOUR = LinearTexture((UV,), (1.0,))
OWN_COLOUR = ObjectValue("colour")


def world_of(*lamps, settings=None):
    floor = h.thing(h.quad((0, 0, -9), (8, 0, 0), (0, 8, 0)))
    return h.plan_of(h.scene([floor], lamps), settings or h.settings()).world


def shaded(light, texture, matrix=None):
    matrix = getattr(light, "world_from_light", TURNED) if matrix is None else matrix
    return h.replaced(light, shade=Shade(texture=texture, world_from_light=matrix))


def light_at(lamp, p, u2=None):
    """(irradiance (3, N), wi (3, N)) at p (3, N), world space, in W m^-2."""
    world = world_of(lamp)
    u2 = np.full((2, p.shape[1]), 0.5, np.float32) if u2 is None else u2
    wi, _, E, _ = world.lights.sample(None, world.frame.points(p).astype(np.float32), u2)
    return E.astype(np.float64), wi


def around(centre, distance, n=4096, seed=1):
    return np.asarray(centre, float)[:, None] + distance * h.directions(seed, n)


@pytest.mark.parametrize(("falloff", "power"), [("quadratic", 2), ("linear", 1), ("constant", 0)])
def test_falloffs_are_powers_of_the_distance(falloff, power):
    """E d^power is the same from a centimetre to a kilometre, and with `smooth` s weakened by d^2 / (s + d^2)."""
    p = np.zeros((3, 6))
    p[0] = (0.01, 0.3, 1.0, 2.0, 40.0, 1000.0)
    d = p[0]
    lamp = PointLight(position=(0.0, 0.0, 0.0), intensity=(3.0,) * 3)
    E, _ = light_at(shaded(lamp, LightFalloff(2.0, 0.0, falloff)), p)
    np.testing.assert_allclose(E * d**power, 6.0, rtol=1e-5)
    E, _ = light_at(shaded(lamp, LightFalloff(2.0, 0.7, falloff)), p)
    np.testing.assert_allclose(E * d**power, np.broadcast_to(6.0 * d * d / (0.7 + d * d), E.shape), rtol=1e-5)


def test_a_sun_has_no_falloff():
    for falloff in ("linear", "constant"):
        E, _ = light_at(shaded(SunLight(irradiance=(1.0, 2.0, 3.0)), LightFalloff(2.0, 5.0, falloff)), np.zeros((3, 1)))
        np.testing.assert_allclose(E[:, 0], (2, 4, 6), rtol=1e-6)


def test_the_flux_through_a_directional_shade_is_its_mean():
    """n_z^2 leaves a third of a bulb's flux; in the bulb's own frame, which is turned."""
    z = Separate(Geometry("object normal"), 2)
    lamp = PointLight(position=tuple(TURNED[:3, 3]), intensity=(2.0,) * 3)
    p = around(TURNED[:3, 3], 3.0)
    E, wi = light_at(shaded(lamp, LinearTexture((z,), (z,))), p)
    np.testing.assert_allclose(E[0], 2 / 9 * h.dots(np.broadcast_to(TURNED[:3, 2:3], wi.shape), wi) ** 2, atol=1e-6)
    assert h.mean_is(9 * E[0] / 2, 1 / 3)


def test_a_gobo_fills_the_cone_of_a_spot():
    """uv = 1/2 + tan / (2 tan(a / 2)) along each axis of its frame, whatever the distance."""
    lamp = SpotLight(world_from_light=TURNED, intensity=(2.0,) * 3, angle=1.2, blend=0.0)
    p = around(TURNED[:3, 3], 5.0, 4096)
    local = TURNED[:3, :3].T @ (p - TURNED[:3, 3:])
    p, local = p[:, local[2] < -5 * math.cos(0.59)], local[:, local[2] < -5 * math.cos(0.59)]
    E, _ = light_at(shaded(lamp, UV_COLOUR), p)
    u, v = 0.5 + local[:2] / (-local[2] * 2 * math.tan(0.6))
    np.testing.assert_allclose(E, 2 / 25 * np.stack((u, v, np.zeros_like(u))), atol=2e-6)
    assert u.min() < 0.1
    assert v.max() > 0.9


@pytest.mark.parametrize("is_ellipse", [False, True])
def test_uv_runs_over_an_area_light(is_ellipse):
    light = AreaLight(world_from_light=TURNED, size_x=0.8, size_y=0.3, is_ellipse=is_ellipse)
    p = (TURNED @ (0.2, 0.1, -2, 1))[:3, None] + np.zeros((1, 500))
    u2 = h.uniform(1, 500, np.float32)
    plain, _ = light_at(light, p, u2)
    E, _ = light_at(shaded(light, UV_COLOUR), p, u2)
    at = area._place(h.table(light.row(h.UNIT_FRAME)), u2.astype(np.float64)) + 0.5
    np.testing.assert_allclose((E / plain)[:2], at, atol=1e-5)


WITH_SIZE = {
    "area": AreaLight(world_from_light=TURNED, size_x=0.8, size_y=0.3, spread=2.0),
    "disk": PointLight(position=(0.3, -0.2, 0.9), radius=0.4),
    "ball": PointLight(position=(0.3, -0.2, 0.9), radius=0.4, soft_falloff=False),
    "spot": SpotLight(world_from_light=TURNED, angle=2.0, radius=0.3),
    "sun": SunLight(towards=(0.0, 0.6, 0.8), angle=0.8),
}
ASKED = {
    "uv": UV_COLOUR,
    "object": NoiseTexture(OBJECT, scale=3.0, is_coloured=True),
    "position": NoiseTexture(POSITION, scale=3.0, is_coloured=True),
    "normal": NoiseTexture(Geometry("normal"), scale=3.0, is_coloured=True),
    "incoming": NoiseTexture(Geometry("incoming"), scale=3.0, is_coloured=True),
    "length": LinearTexture((LightPath("length"),), (0.01,)),
}


def check_met_as_sampled(light, texture):
    """A ray along a sampled direction meets the light with the radiance that the sample claims."""
    world = world_of(shaded(light, texture))
    origin = (TURNED @ (0.2, 0.1, -1.5, 1))[:3, None]
    p = np.repeat(world.frame.points(origin).astype(np.float32), 500, axis=1)
    wi, _, E, pdf = world.lights.sample(None, p, h.uniform(2, 500, np.float32))
    ((lamp, _),) = world.lights.hittable.along(p, wi, None)
    t, L, _ = lamp.light.hit(lamp.k, p, wi)
    met = np.nonzero(np.isfinite(t))[0]
    assert met.size > 490
    L = np.broadcast_to(L, (3, 500)).take(met, axis=1)
    L = world.lights.groups[lamp.group].glow.lit(L, lamp.k, p.take(met, axis=1), wi.take(met, axis=1), np.broadcast_to(t, (500,)).take(met))
    sampled = (E * pdf).take(met, axis=1)
    assert sampled.max() > 0
    np.testing.assert_allclose(L, sampled, atol=1e-3 * sampled.max())


@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("kind", WITH_SIZE)
def test_a_shaded_light_is_met_as_it_is_sampled(kind, asked):
    if (kind, asked) == ("sun", "length"):
        pytest.skip("the way to a sun is the largest of all numbers")
    check_met_as_sampled(WITH_SIZE[kind], ASKED[asked])


def test_a_light_that_is_met_elsewhere_than_it_is_sampled_is_noticed(monkeypatch):
    """The mutant is a hundredth nearer where rays meet it."""
    hit = AreaLight.hit

    def nearer(k, o, d):
        t, L, pdf = hit(k, o, d)
        return 0.99 * t, L, pdf

    monkeypatch.setattr(AreaLight, "hit", staticmethod(nearer))
    with pytest.raises(AssertionError):
        check_met_as_sampled(WITH_SIZE["area"], UV_COLOUR)


def test_lights_of_a_kind_have_their_own_shades():
    """Two shaded bulbs and a plain one: each shines as it does alone."""
    lamps = [PointLight(name=str(i), position=(i, 0.0, 0.0), intensity=(1.0,) * 3) for i in range(4)]
    lamps[1] = shaded(lamps[1], OWN_COLOUR)
    lamps[1] = h.replaced(lamps[1], shade=h.replaced(lamps[1].shade, values=(("colour", (0.5, 0.25, 0.125, 1.0)),)))
    lamps[3] = h.replaced(lamps[3], shade=h.replaced(lamps[1].shade, values=(("colour", (0.1, 0.2, 0.3, 1.0)),)))
    lamps[2] = shaded(lamps[2], CheckerTexture((0.0,) * 3, (0.0,) * 3))
    world = world_of(*lamps)
    p = world.frame.points(np.array([[0.0], [0.0], [2.0]]) + np.zeros((1, 4))).astype(np.float32)
    _, distance, E, _ = world.lights.sample(np.arange(4), p, np.full((2, 4), 0.5, np.float32))
    x = np.round(np.sqrt((distance / world.frame.scale) ** 2 - 4))
    gain = (E * (4 + x * x) / 1.0).T
    found = {int(place): tuple(np.round(row, 4)) for place, row in zip(x, gain)}
    assert found == {0: (1, 1, 1), 1: (0.5, 0.25, 0.125), 2: (0, 0, 0), 3: (np.float32(0.1), np.float32(0.2), np.float32(0.3))}


def test_lights_are_chosen_by_what_their_shades_leave():
    lamps = [PointLight(position=(x, 0.0, 0.0), intensity=(1.0,) * 3) for x in (-1.0, 1.0)]
    lamps[1] = shaded(lamps[1], LightFalloff(0.01))
    world = world_of(*lamps)
    p = world.frame.points(np.array([[0.0], [0.0], [2.0]])).astype(np.float32)
    chance = world.lights.choice.probability(np.array([0, 1]), np.repeat(p, 2, axis=1), None)
    assert chance[1] / chance[0] == pytest.approx(0.01, rel=0.05)
    lamps[1] = shaded(lamps[1], LightFalloff(0.0))
    world = world_of(*lamps)
    black = world.lights.choice.probability(np.array([0, 1]), np.repeat(p, 2, axis=1), None)
    assert 0 < black[1] < chance[1]


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan])
def test_a_light_that_is_dark_through_its_texture_is_told_by_its_name(value):
    dark = LinearTexture((NoiseTexture(OBJECT),), (value,))
    narrow = SpotLight(name="Key", angle=0.01, intensity=(1.0, 0.0, 0.0))
    (warning,) = world_of(shaded(SpotLight(name="Gobo"), dark), shaded(narrow, UV_COLOUR)).warnings
    assert "light 'Gobo'" in warning


def test_the_share_of_a_narrow_beam_is_that_within_it():
    """A gobo that is red to the right: half of it; the other channels are 0."""
    lamp = shaded(SpotLight(world_from_light=TURNED, angle=0.02, blend=0.0), UV_COLOUR)
    world = world_of(lamp)
    np.testing.assert_allclose(share_left(lamp, world.frame, world.camera, 9.0), (0.5, 0.5, 0.0), atol=0.01)


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf])
def test_what_is_no_light_counts_as_none(value):
    lamp = PointLight(position=(0.0, 0.0, 0.0), intensity=(3.0,) * 3)
    E, _ = light_at(shaded(lamp, VectorMath(Geometry("normal"), (value,) * 3, operation="multiply")), around((0, 0, 0), 1.0, 64))
    assert np.isfinite(E).all()
    assert (E >= 0).all()


@pytest.mark.parametrize("kind", WITH_SIZE)
def test_every_texture_may_be_asked_of_a_light(kind):
    """Also what only meshes know, and what looks around: it gives numbers, and lights are chosen by them."""
    # The tables of a sky take seconds.
    textures = [plugin() for plugin in TEXTURES.values() if plugin.key != "sky"]
    bumped = BumpMap(NoiseTexture(OBJECT), normal=Geometry("normal"))
    world = world_of(*(shaded(WITH_SIZE[kind], texture) for texture in (*textures, bumped)))
    index = np.arange(len(textures) + 1)
    p = np.repeat(world.frame.points(np.array([[0.2], [0.1], [-1.5]])).astype(np.float32), index.size, axis=1)
    _, _, E, _ = world.lights.sample(index, p, h.uniform(1, index.size, np.float32))
    assert np.isfinite(E).all()
    assert (E >= 0).all()
    assert (world.lights.choice.probability(index, p, None) > 0).all()


def test_what_is_no_shade_is_refused_with_the_name_of_the_light():
    for shade in (UV_COLOUR, Shade(texture=0.5), Shade(texture=UV_COLOUR, world_from_light=np.full((4, 4), np.nan))):
        with pytest.raises(SceneError, match="light 'Gobo'"):
            validate(h.scene([], [SpotLight(name="Gobo", shade=shade)]), h.settings())
    _, warnings = validate(h.scene([], [SpotLight(name="Gobo", shade=Shade(texture=LightPath("depth")))]), h.settings())
    assert "light 'Gobo'" in warnings[0]
