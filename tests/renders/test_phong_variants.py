"""The three normalisations of Phong's highlight in pictures: their albedo in white light, and one light found in every way."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, BlinnPhong, Lambert, Material, Phong, PhongLecture, PointLight
from glanz.engine.bsdfs import blinn_phong
from glanz.tests import chance, helpers as h
from glanz.tests.renders.test_two_ways import image_of

LECTURE = Material(name="lecture", lobes=(PhongLecture((0.9,) * 3, 10.0),))
BLINN = Material(name="blinn", lobes=(BlinnPhong((1.0,) * 3, 40.0),))
ALL_THREE = Material(name="all", lobes=(Lambert((0.2,) * 3), Phong((0.2,) * 3, 50), PhongLecture((0.2,) * 3, 5), BlinnPhong((0.2,) * 3, 9)))


def blinn_albedo(angle, n):
    """Integral of f cos over the hemisphere, in float64 and plain formulas: a fine grid of half vectors about the normal."""
    u, phi = np.meshgrid((np.arange(2_000) + 0.5) / 2_000, (np.arange(1_000) + 0.5) / 1_000 * np.pi, indexing="ij")
    cos = u ** (1 / (n + 1))
    along = math.sin(angle) * np.sqrt(1 - cos**2) * np.cos(phi) + math.cos(angle) * cos
    lit = 2 * along * cos - math.cos(angle)
    factor = (n + 2) * (n + 4) / (8 * math.pi * (2 ** (-n / 2) + n))
    return (factor * 8 * math.pi / (n + 1) * np.maximum(along, 0) * np.maximum(lit, 0)).mean()


def in_white_light(material, degrees):
    scene = h.replaced(h.receiver(material=material, tilt=math.radians(degrees)), world=h.World(radiance=(1.0,) * 3))
    return h.pixels(scene, h.settings(width=16, height=16, samples=256, max_depth=0))[0]


@pytest.mark.parametrize("degrees", [0, 45, 80])
@chance.fresh
def test_blinn_phong_shows_its_albedo_in_white_light(degrees):
    """F2; detects 0.5 %."""
    assert h.mean_is(in_white_light(BLINN, degrees), blinn_albedo(math.radians(degrees), 40.0), floor=1e-4)


@pytest.mark.parametrize(("degrees", "n"), [(0, 10.0), (60, 0.0)])
@chance.fresh
def test_the_lectures_lobe_shows_its_albedo_in_white_light(degrees, n):
    """k_s (n + 2) / (n + 1) of the lobe above the horizon: all of it at 0 degrees, 2 / 3 of the half space at 60."""
    k_s = (n + 1) / (n + 2)
    image = in_white_light(Material(name="lecture", lobes=(PhongLecture((k_s,) * 3, n),)), degrees)
    assert h.mean_is(image, 1 if degrees == 0 else 2 / 3, floor=1e-4)


def test_the_albedo_catches_the_factor_of_another_lobe(monkeypatch):
    monkeypatch.setattr(blinn_phong, "factor", lambda n: (n + 8) / (8 * math.pi))
    assert not h.mean_is(in_white_light(BLINN, 0), blinn_albedo(0.0, 40.0), floor=1e-4)


@pytest.mark.parametrize("material", [LECTURE, BLINN, ALL_THREE], ids=lambda m: m.name)
@pytest.mark.parametrize("name", ["area", "ball", "mesh"])
@chance.fresh
def test_every_way_finds_the_same_light(monkeypatch, name, material):
    """E14: shadow rays, scattered rays, both; Welch's t over 144 pixels, detects 3 %."""
    lights, objects = {
        "area": ([AreaLight(world_from_light=h.affine(np.eye(3), (0.1, 0.2, 0.7)))], []),
        "ball": ([PointLight(position=(0.1, 0.2, 1.0), radius=0.6, soft_falloff=False)], []),
        "mesh": ([], [h.thing(h.quad((0.1, 0.2, 0.7)), h.lambert(0, "lamp", 1.0))]),
    }[name]
    scene = h.receiver(lights, objects, material=material, distance=0.3, tilt=0.5)
    images = {way: image_of(monkeypatch, way, scene, seed) for seed, way in enumerate(("shadow rays", "scattered rays", "both"))}
    assert images["both"].mean() > 0
    assert h.means_agree(images["shadow rays"], images["both"], floor=1e-4)
    assert h.means_agree(images["scattered rays"], images["both"], floor=1e-4)


def test_a_highlight_seen_straight_is_alike_in_all_three():
    """Viewer and lamp near the normal: f of modified Phong, the lecture's and Blinn's with 4 n within 2 %."""
    lamp = PointLight(position=(0.1, 0.0, 2.0), intensity=(1.0,) * 3)
    lobes = (Phong((0.5,) * 3, 50.0), PhongLecture((0.5,) * 3, 50.0), BlinnPhong((0.5,) * 3, 200.0))
    scenes = [h.receiver([lamp], material=Material(name="m", lobes=(lobe,))) for lobe in lobes]
    seen = [h.pixels(scene, h.settings(samples=1, max_depth=0)).mean() for scene in scenes]
    assert max(seen) / min(seen) - 1 <= 0.02
