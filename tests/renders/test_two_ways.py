"""Light found by shadow rays, by scattered rays and by both is one light (catalogue E14)."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, Material, Phong, PointLight, SpotLight, SunLight, Transparent
from glanz.engine.wavefront import direct, emission, escape, mis
from glanz.engine.wavefront.mis import power_heuristic
from glanz.tests import chance, helpers as h
from glanz.tests.polygons import polygon_irradiance

WHITE = h.lambert(1.0)
GLOSSY = Material(name="glossy", lobes=(Phong((1.0, 1.0, 1.0), 8.0),))
MIXED = Material(name="mixed", lobes=(*h.lambert(0.4).lobes, Phong((0.5, 0.5, 0.5), 50.0)))
CLOSE = h.affine(np.eye(3), (0.1, 0.2, 0.7))
LIGHTS = {
    "area": ([AreaLight(world_from_light=CLOSE)], []),
    "ellipse": ([AreaLight(world_from_light=CLOSE, size_y=0.6, is_ellipse=True)], []),
    "spread": ([AreaLight(world_from_light=CLOSE, spread=2.0)], []),
    "soft bulb": ([PointLight(position=(0.1, 0.2, 1.0), radius=0.6)], []),
    "ball": ([PointLight(position=(0.1, 0.2, 1.0), radius=0.6, soft_falloff=False)], []),
    "spot": ([SpotLight(world_from_light=h.affine(np.eye(3), (0.1, 0.2, 1.0)), radius=0.6, angle=2.0)], []),
    "sun": ([SunLight(angle=1.0)], []),
    "mesh": ([], [h.thing(h.quad((0.1, 0.2, 0.7)), h.lambert(0, "lamp", 1.0))]),
    "polygons": ([], [h.thing(h.icosphere(1, 0.4, (0.1, 0.2, 0.9)), h.lambert(0, "lamp", 1.0))]),
    "two kinds": ([AreaLight(world_from_light=CLOSE, radiance=(0.3,) * 3)], [h.thing(h.quad((-0.5, 0.2, 0.6)), h.lambert(0, "lamp", 1.0))]),
}


def use(monkeypatch, way):
    """Let light be found by "shadow rays" or "scattered rays" only, or "both" as it is meant."""
    if way == "both":
        return
    for module, weight in ((direct, way == "shadow rays"), (emission, way == "scattered rays"), (escape, way == "scattered rays")):
        monkeypatch.setattr(module, "power_heuristic", lambda pdf, other, weight=weight: np.float32(weight))


def image_of(monkeypatch, way, scene, seed, depth=0, samples=100):
    with monkeypatch.context() as patch:
        use(patch, way)
        settings = h.settings(width=12, height=12, samples=samples, max_depth=depth, seed=seed)
        return h.pixels(scene, settings)[0].astype(np.float64)


@pytest.mark.parametrize("material", [WHITE, GLOSSY, MIXED], ids=lambda m: m.name)
@pytest.mark.parametrize("name", LIGHTS)
@chance.fresh
def test_every_way_finds_the_same_light(monkeypatch, name, material):
    """Welch's t over 144 pixels; detects 1 to 3 %. Each picture has numbers of its own."""
    lights, objects = LIGHTS[name]
    scene = h.receiver(lights, objects, material=material, distance=0.3, tilt=0.5)
    images = {way: image_of(monkeypatch, way, scene, seed) for seed, way in enumerate(("shadow rays", "scattered rays", "both"))}
    assert images["both"].mean() > 0
    assert h.means_agree(images["shadow rays"], images["both"], floor=1e-4)
    assert h.means_agree(images["scattered rays"], images["both"], floor=1e-4)


@pytest.mark.parametrize("name", LIGHTS)
@chance.fresh
def test_every_way_finds_the_same_light_behind_a_half_transparent_sheet(monkeypatch, name):
    """By chance for scattered rays, by its share for shadow rays; the sheet reflects as well, which both ways know."""
    lights, objects = LIGHTS[name]
    veil = Material(name="veil", lobes=(Transparent((0.5, 0.5, 0.5)), *h.lambert(0.4).lobes))
    sheet = h.thing(h.quad((0, 0, 0.4), (50, 0, 0.1), (0, 50, 0), name="sheet"), veil)
    scene = h.receiver(lights, [*objects, sheet], material=MIXED, distance=0.3, tilt=0.5)
    images = {way: image_of(monkeypatch, way, scene, seed) for seed, way in enumerate(("shadow rays", "scattered rays", "both"))}
    assert images["both"].mean() > 0
    assert h.means_agree(images["shadow rays"], images["both"], floor=1e-4)
    assert h.means_agree(images["scattered rays"], images["both"], floor=1e-4)


def test_the_same_light_is_the_one_of_the_closed_form(monkeypatch):
    corners = [(x, y, 0.7) for x, y in ((-0.4, -0.3), (0.6, -0.3), (0.6, 0.7), (-0.4, 0.7))]
    truth = polygon_irradiance(corners, (0, 0, 0), (0, 0, 1)) / math.pi
    for seed, way in enumerate(("shadow rays", "scattered rays", "both")):
        image = image_of(monkeypatch, way, h.receiver(*LIGHTS["mesh"], distance=0.3, tilt=0.5), seed)
        assert h.mean_is(image, truth, floor=1e-5), way


@chance.fresh
def test_ways_agree_over_many_bounces(monkeypatch):
    """In a box with a lamp in it, up to four bounces; detects 2 %."""
    objects = [h.thing(h.box(), h.lambert(0.6)), h.thing(h.quad((0.5, 0.5, 0.9), (0.5, 0, 0), (0, 0.5, 0)), h.lambert(0, "lamp", 1.0))]
    scene = h.scene(objects, camera=h.PerspectiveCamera.look_at((0.3, 0.4, 0.5), (0.9, 0.8, 0.2)))
    images = [image_of(monkeypatch, way, scene, seed, depth=3) for seed, way in enumerate(("shadow rays", "scattered rays", "both"))]
    # Pixels differ, so means are compared pixel by pixel.
    for other in images[:2]:
        assert h.mean_is(other - images[2], 0.0)


@pytest.mark.parametrize(
    "mutant",
    [
        (direct, lambda pdf, other: power_heuristic(pdf, other) + np.float32(0.1)),
        (emission, lambda pdf, other: np.float32(1)),
        (emission, lambda pdf, other: power_heuristic(other, pdf)),
        (direct, lambda pdf, other: power_heuristic(pdf * 2, other)),
    ],
    ids=["a tenth too much", "counted twice", "the other's weight", "another density"],
)
def test_ways_catch_weights_that_do_not_sum_to_one(monkeypatch, mutant):
    scene = h.receiver(*LIGHTS["mesh"], distance=0.3, tilt=0.5)
    truth = image_of(monkeypatch, "shadow rays", scene, 1)
    with monkeypatch.context() as patch:
        patch.setattr(mutant[0], "power_heuristic", mutant[1])
        assert not h.means_agree(image_of(monkeypatch, "both", scene, 2), truth, floor=1e-4)


def test_weights_sum_to_one():
    """D: w(a, b) + w(b, a) = 1 in float32, for densities whose squares would overflow; infinite densities weigh 1."""
    a, b = 10.0 ** np.random.default_rng(1).uniform(-30, 30, (2, 10_000))
    a, b = a.astype(np.float32), b.astype(np.float32)
    np.testing.assert_allclose(mis.power_heuristic(a, b) + mis.power_heuristic(b, a), 1, rtol=1e-6)
    assert mis.power_heuristic(np.float32(np.inf), np.float32(3)) == 1
    assert mis.power_heuristic(np.float32(3), np.float32(0)) == 1


def test_a_light_that_scattered_rays_cannot_meet_is_left_to_shadow_rays(monkeypatch):
    """A bulb without a size: nothing is lost, and scattered rays alone find nothing."""
    scene = h.receiver([PointLight(position=(0.1, 0.2, 1.0))], material=WHITE)
    assert image_of(monkeypatch, "scattered rays", scene, 1).max() == 0
    assert h.same_bits(image_of(monkeypatch, "shadow rays", scene, 1), image_of(monkeypatch, "both", scene, 1))


def test_brighter_plates_are_found_with_little_noise_at_every_sharpness(monkeypatch):
    """Veach's plates: for a sharp and a dull surface, both ways together are at most 1.5 times as noisy as the better."""
    for exponent in (2.0, 2000.0):
        material = Material(name="plate", lobes=(Phong((1.0,) * 3, exponent),))
        frame = h.affine(h.frame_towards((-0.6, 0, 0.8)), (-0.6, 0, 0.8))
        scene = h.receiver(
            [AreaLight(world_from_light=frame, size_x=0.3, size_y=0.3)], material=material, distance=0.3, tilt=math.atan(0.75)
        )
        noise = {way: image_of(monkeypatch, way, scene, 1, samples=16).std() for way in ("shadow rays", "scattered rays", "both")}
        assert noise["both"] <= 1.5 * min(noise["shadow rays"], noise["scattered rays"]), exponent
