"""A picture around the scene lights it: closed forms, both ways to find it, turned pictures (catalogue E13 to E15)."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, EnvironmentMap, Material, PanoramaCamera, Phong, PointLight, Requirements, SunLight, World
from glanz.engine.plan import Plan
from glanz.engine.wavefront import direct, escape
from glanz.engine.world.environment import Environment
from glanz.tests import chance, helpers as h

GLOSSY = Material(name="glossy", lobes=(Phong((0.8, 0.6, 0.4), 30.0),))
NOISE = np.random.default_rng(3).random((3, 8, 16)).astype(np.float32) ** 3
SPOT = np.full((3, 8, 16), 0.2, np.float32)
SPOT[:, 2, 6] = 300
HALF = np.zeros((3, 64, 4), np.float32)
HALF[:, :32] = 1


def sky(pixels=NOISE, radiance=0.0, **changes):
    return World(name="Sky", radiance=h.grey(radiance), environment=EnvironmentMap(pixels=pixels, **changes))


def under(world, scene=None, **changes):
    return h.replaced(scene or h.receiver(**changes), world=world)


def irradiances(scene, **changes):
    """Irradiance (3, 64) that each pixel tells."""
    image = h.pixels(scene, h.settings(**{"samples": 64, "max_depth": 0, **changes}))
    return image.reshape(3, -1).astype(np.float64) * math.pi


TRUTHS = {
    "constant": (sky(np.ones((3, 8, 16))), math.pi),
    "one pixel": (sky(np.ones((3, 1, 1))), math.pi),
    "one pixel, times strength, plus background": (sky(np.full((3, 1, 1), 0.5), 0.75, strength=(0.5,) * 3), math.pi),
    "upper half": (sky(HALF, interpolation="closest"), math.pi),
    "lower half": (sky(HALF[:, ::-1], interpolation="closest"), 0.0),
    "half, turned upright": (sky(HALF, interpolation="closest", world_from_map=h.frame_towards((1, 0, 0))), math.pi / 2),
    "front half": (sky(np.roll(np.repeat(HALF[:, :1, :1], 8, 2) * (np.arange(8) < 4), -2, 2), interpolation="closest"), math.pi / 2),
}


@pytest.mark.parametrize("name", TRUTHS)
@chance.fresh
def test_skies_give_the_closed_form(name):
    """E15: an even sky pi, half of it pi / 2; detects 0.5 %."""
    world, truth = TRUTHS[name]
    values = irradiances(under(world), samples=256)
    assert h.mean_is(values[0], truth, floor=1e-5)


def test_the_closed_form_catches_a_sky_that_shadow_rays_find_too_bright(monkeypatch):
    sample = Environment.sample

    def brighter(self, p, u2):
        wi, distance, E, pdf = sample(self, p, u2)
        return wi, distance, 1.02 * E, pdf

    monkeypatch.setattr(Environment, "sample", brighter)
    assert not h.mean_is(irradiances(under(TRUTHS["constant"][0]), samples=256)[0], math.pi, floor=1e-5)


@chance.fresh
def test_a_patch_sees_of_a_picture_what_quadrature_says():
    """Irradiance of a tilted patch under noise, against a sum over directions; detects 0.5 %."""
    normal = np.array((0.3, -0.5, 0.6)) / math.sqrt(0.7)
    v, u = ((np.arange(m) + 0.5) / m for m in (1200, 2400))
    theta, phi = math.pi * v[:, None], math.pi * (1 - 2 * u)
    d = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)))
    world = sky(world_from_map=h.rotation(5))
    L = Environment.of(world).radiance(d.reshape(3, -1).astype(np.float32)).reshape(3, 1200, 2400)
    cos = np.maximum(np.tensordot(normal, d, 1), 0)
    truth = (L * cos * np.sin(theta)).mean(axis=(1, 2)) * 2 * math.pi**2
    values = irradiances(under(world, normal=normal), samples=400)
    for channel in range(3):
        assert h.mean_is(values[channel], truth[channel], floor=1e-4)


def test_a_camera_sees_the_picture_as_it_is():
    """E13: a panorama that looks along +x shows the picture itself; nothing is noise, nothing is turned."""
    camera = PanoramaCamera(world_from_camera=h.affine(np.array([[0, 0, -1], [-1, 0, 0], [0, 1, 0]], float)))
    scene = h.scene(camera=camera)
    image = h.pixels(under(sky(interpolation="closest"), scene), h.settings(width=16, height=8))
    # The very first sample falls on the pole, where rounding decides for a pixel.
    assert np.isclose(image, NOISE, rtol=1e-6).mean() >= 1 - 2 / 128
    # A quarter turn about +z moves it by a quarter of its width, to the left, where +y is.
    turned = sky(interpolation="closest", world_from_map=np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]))
    image = h.pixels(under(turned, scene), h.settings(width=16, height=8))
    assert np.isclose(image, np.roll(NOISE, -4, axis=2), rtol=1e-6).mean() >= 1 - 2 / 128


def balls(turn, material):
    """A ball on a floor and the camera, all turned about the origin."""
    matrix = h.affine(turn)
    ball, floor = h.icosphere(2, 0.5, (0, 0, 0.5), smooth=True), h.quad(x=(3, 0, 0), y=(0, 3, 0))
    objects = [h.thing(ball, material, matrix), h.thing(floor, matrix=matrix)]
    camera = h.PerspectiveCamera.look_at((1.5, -2, 1.2), (0, 0, 0.4))
    return h.scene(objects, camera=h.replaced(camera, world_from_camera=matrix @ camera.world_from_camera))


@pytest.mark.parametrize("seed", [1, 2])
def test_a_turned_picture_is_a_turned_scene(seed):
    """E15: what is turned with its sky looks the same, to 3 % in each of 16 blocks; a sky that stays behind is noticed."""
    turn = h.rotation(seed)
    one = h.settings(width=16, height=16, samples=1024, max_depth=1)

    def blocks(world, scene, seed):
        return h.pixels(under(world, scene), h.replaced(one, seed=seed))[0].reshape(4, 4, 4, 4).mean(axis=(1, 3))

    still = blocks(sky(SPOT), balls(np.eye(3), GLOSSY), 0)
    turned = blocks(sky(SPOT, world_from_map=turn), balls(turn, GLOSSY), 1)
    left_behind = blocks(sky(SPOT), balls(turn, GLOSSY), 1)
    assert np.abs(turned / still - 1).max() < 0.03
    assert np.abs(left_behind / still - 1).max() > 0.3


def image_of(scene, seed, **changes):
    return h.pixels(scene, h.settings(width=12, height=12, samples=100, seed=seed, **{"max_depth": 0, **changes}))[0].astype(np.float64)


@pytest.mark.parametrize("pixels", [NOISE, SPOT], ids=["noise", "spot"])
@pytest.mark.parametrize("material", [h.lambert(0.8), GLOSSY], ids=lambda m: m.name)
@chance.fresh
def test_every_way_finds_the_same_sky(monkeypatch, pixels, material):
    """E14: shadow rays, scattered rays and both, with and without lamps that share the choice; Welch over 144 pixels."""
    for lights in ((), (PointLight(position=(0.2, 0.3, 1.0)), SunLight(angle=0.2, irradiance=(0.3,) * 3))):
        scene = under(sky(pixels), lights=lights, material=material, tilt=0.5)
        both = image_of(scene, 1)
        ways = {}
        for seed, way in enumerate(("shadow rays", "scattered rays"), start=2):
            with monkeypatch.context() as patch:
                patch.setattr(Environment, "hit", _never_met(patch, way))
                ways[way] = image_of(scene, seed)
        for way, image in ways.items():
            assert h.means_agree(image, both, floor=1e-4), way


def _never_met(patch, way):
    """Changes what the sky tells of its densities so that one way does all the work; lamps keep both."""
    hit, sample = Environment.hit, Environment.sample

    def with_density(result, density):
        return (*result[:-1], np.full_like(result[-1], density))

    shadow_rays_win = np.inf if way == "shadow rays" else 2.0**-100
    patch.setattr(Environment, "sample", lambda self, p, u2: with_density(sample(self, p, u2), shadow_rays_win))
    return lambda self, d: with_density(hit(self, d), shadow_rays_win)


@pytest.mark.parametrize("module", [direct, escape])
def test_ways_catch_weights_that_do_not_sum_to_one(monkeypatch, module):
    scene = under(sky(NOISE), material=h.lambert(0.8))
    truth = image_of(scene, 1)
    monkeypatch.setattr(module, "power_heuristic", lambda pdf, other: np.float32(1))
    assert not h.means_agree(image_of(scene, 2), truth, floor=1e-4)


def test_integrators_without_shadow_rays_find_the_same_sky():
    scene = under(sky(NOISE), balls(np.eye(3), h.lambert(0.7)))
    path, blind = (image_of(scene, seed, max_depth=2, integrator=key) for seed, key in ((1, "path"), (2, "path_blind")))
    assert h.mean_is(path - blind, 0.0)


def test_a_small_bright_spot_is_found_at_once():
    """What importance sampling is for: a thirtieth of the noise of scattered rays alone, or less."""
    scene = under(sky(SPOT * np.where(SPOT > 1, 100, 1).astype(np.float32)))
    path, blind = (image_of(scene, 1, integrator=key) for key in ("path", "path_blind"))
    assert path.std() <= blind.std() / 30


@pytest.mark.parametrize("lights", [(), (AreaLight(size_x=0.5), PointLight(position=(1.0, 0.0, 2.0)))], ids=["alone", "with lamps"])
def test_pruned_is_unpruned(lights):
    """A world with every feature asked for, and with the two that it needs, renders to the same bits."""
    settings = h.settings(max_depth=2)
    for world in (sky(), sky(radiance=0.2), sky(np.zeros((3, 2, 2))), sky(np.zeros((3, 2, 2)), 0.2)):
        scene = under(world, balls(np.eye(3), h.lambert(0.7)))
        scene = h.replaced(scene, lights=lights)
        pruned, full = (Plan.of(scene, settings, ask(scene, settings)) for ask in (Requirements.of, Requirements.everything))
        assert h.same_bits(h.pixels_of_plan(pruned), h.pixels_of_plan(full))
        assert (escape.add_environment in pruned.on_rays) == bool(world.environment.pixels.any())


def test_black_pictures_cost_nothing():
    """B10: a black picture is no light, and what a world does not have is not run."""
    for world in (sky(np.zeros((3, 4, 8))), sky(strength=(0.0,) * 3), World()):
        plan = h.plan_of(under(world), h.settings())
        assert plan.on_rays == ()
        assert plan.world.lights.is_empty
    assert h.plan_of(under(World(radiance=(1.0,) * 3)), h.settings()).on_rays == (escape.add_background,)


def test_a_pixel_of_1e30_leaves_every_sample_finite():
    pixels = SPOT.copy()
    pixels[:, 2, 6] = 1e30
    image = h.pixels(under(sky(pixels), balls(np.eye(3), GLOSSY)), h.settings(max_depth=2))
    assert np.isfinite(image).all()
    assert image.max() > 1e25
