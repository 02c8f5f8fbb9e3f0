"""Penumbras by closed form, and lights found by shadow rays and by scattered ones (numerics E9, E14, F9)."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, Material, Mirror, PerspectiveCamera, Phong
from glanz.engine.wavefront import direct, emission, escape, mis
from glanz.tests import chance, helpers as h

WIDTH, HEIGHT, EDGE = 0.2, 3.0, 1.0
"""Of a strip light [m], its height, and that of the edge below it: E9 of the catalogue."""


def penumbra(height=EDGE):
    """A long strip light along y over the floor, a half-plane x > 0 at `height`; irradiance along x, by pixel."""
    strip = AreaLight(world_from_light=h.affine(translation=(0, 0, HEIGHT)), size_x=WIDTH, size_y=30, radiance=(1.0,) * 3)
    cover = h.thing(h.quad((50, 0, height), (100, 0, 0), (0, 900, 0)), h.lambert(0))
    floor = h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)), h.lambert(1.0))
    camera = PerspectiveCamera.look_at((0, 0, 0.9), (0, 0, 0), up=(0, 1, 0), fov=2 * math.atan(0.1 / 0.9))
    settings = h.settings(width=40, height=40, samples=1024, max_depth=0, sampler="sobol", filter_width=1.0)
    return np.pi * h.pixels(h.scene([floor, cover], [strip], camera), settings)[0].mean(axis=0)


def penumbra_truth():
    """E of the part of an infinite strip between angles: (sin b - sin a) / 2 times pi L of the plane, here L = 1, averaged over pixels.

    The edge at x = 0 hides from a point x on the floor what lies beyond x - x HEIGHT / EDGE on the lamp's plane.
    """
    x = (np.arange(40 * 64) + 0.5) / (40 * 64) * 0.2 - 0.1
    visible = np.clip(-x * (HEIGHT / EDGE - 1), -WIDTH / 2, WIDTH / 2)
    low, high = (np.sin(np.arctan((end - x) / HEIGHT)) for end in (-WIDTH / 2, visible))
    return (0.5 * np.pi * (high - low)).reshape(40, 64).mean(axis=1)


def check_penumbra():
    # 40 rows of 1,024 samples: noise of 0.2 % of the full light; what lies beyond the ends of the strip is as little.
    np.testing.assert_allclose(penumbra(), penumbra_truth(), atol=0.01 * penumbra_truth().max())


def test_a_strip_light_casts_the_penumbra_of_similar_triangles():
    """Its width is w h / (H - h) = 0.1, from full light to none; detects a border that is off by a tenth of a pixel."""
    truth = penumbra_truth()
    assert truth[-10] == 0
    assert truth[9] > 0.99 * truth.max() * math.cos(0.05)
    check_penumbra()


def test_the_penumbra_catches_an_edge_at_another_height():
    assert np.abs(penumbra(height=1.05 * EDGE) - penumbra_truth()).max() > 0.01 * penumbra_truth().max()


# Lights found in two ways: Veach's plates

EXPONENTS = (0.0, 10.0, 300.0, 10_000.0)


def plate(exponent):
    """A glossy plate that mirrors two lamps, a large and a small one, into the camera."""
    glossy = Material(name="glossy", lobes=(Phong((0.9,) * 3, exponent),))
    plate = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), glossy)
    lamps = [
        h.thing(h.icosphere(1, radius, (x, 2.0, 2.0), name=str(x)), Material(name="glow", emission=(0.1 / radius**2,) * 3))
        for x, radius in ((-0.5, 0.4), (0.5, 0.05))
    ]
    return h.scene([plate, *lamps], camera=PerspectiveCamera.look_at((0, -2.4, 2.4), (0, 0, 0), fov=0.6))


def one_way(monkeypatch, weight):
    """Weigh shadow rays by weight(1, 0), scattered rays by weight(0, 1)."""
    monkeypatch.setattr(direct, "power_heuristic", lambda pdf, other: np.full_like(pdf, weight))
    for module in (emission, escape):
        monkeypatch.setattr(module, "power_heuristic", lambda pdf, other: np.full_like(pdf, 1 - weight))


def tiles(monkeypatch, weight, exponent, samples=32):
    """(replicates, 4): means of the quarters of the picture, with a seed for each replicate; `weight` None: both ways."""
    with monkeypatch.context() as patch:
        if weight is not None:
            one_way(patch, weight)
        pictures = []
        for seed in range(20):
            settings = h.settings(width=32, height=32, samples=samples, max_depth=0, sampler="random", seed=seed)
            pictures.append(h.pixels(plate(exponent), settings)[0].reshape(2, 16, 2, 16).mean(axis=(1, 3)).ravel())
    return np.array(pictures)


@pytest.mark.parametrize("exponent", EXPONENTS)
@chance.fresh
def test_lights_are_found_alike_by_shadow_rays_scattered_rays_and_both(monkeypatch, exponent):
    """E14: equal means on tiles of 16 x 16; where one way is hopeless (a sharp lobe, a small lamp) it is left out."""
    both = tiles(monkeypatch, None, exponent)
    for weight in (1.0, 0.0):
        alone = tiles(monkeypatch, weight, exponent)
        for a, b in zip(alone.T, both.T):
            if a.std() < 2 * a.mean():
                assert h.means_agree(a, b), (weight, a.mean(), b.mean())
    # Both together are never much worse than the better of the two.
    noise = [tiles(monkeypatch, weight, exponent).std(axis=0).mean() for weight in (1.0, 0.0)]
    assert both.std(axis=0).mean() <= 1.6 * min(noise)


def test_the_plates_catch_weights_that_do_not_add_up_to_one(monkeypatch):
    monkeypatch.setattr(direct, "power_heuristic", lambda pdf, other: 1.1 * mis.power_heuristic(pdf, other))
    both = tiles(monkeypatch, None, 10.0)
    monkeypatch.undo()
    alone = tiles(monkeypatch, 1.0, 10.0)
    assert not all(h.means_agree(a, b) for a, b in zip(both.T, alone.T))


# From gloss to the mirror


def gloss(integrator, lobe, samples=1, side=2):
    """What a plate sees of a large lamp in mirror direction, with a step in its brightness beside the reflected point."""
    plate = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), Material(name="plate", lobes=(lobe,)))
    lamp = h.thing(h.quad((-0.7, 3, 3), (1.5, 0, 0), (0, 4, -4)), Material(name="a", emission=(1.0,) * 3))
    other = h.thing(h.quad((0.8, 3, 3), (1.5, 0, 0), (0, 4, -4)), Material(name="b", emission=(3.0,) * 3))
    camera = PerspectiveCamera.look_at((0, -3, 3), (0, 0, 0), fov=1e-5)
    settings = h.settings(width=side, height=side, samples=samples, max_depth=1, branches=4, sampler="random", integrator=integrator)
    return h.pixels(h.scene([plate, lamp, other], camera=camera), settings)[0]


@pytest.mark.parametrize("integrator", ["distributed", "path"])
def test_ever_sharper_gloss_becomes_a_mirror_times_the_cosine(integrator):
    """F9 and C5: exponent 1e6 is Whitted's mirror of k cos(45 degrees); exponent 0 is finite; detects 0.5 %."""
    mirror = gloss("whitted", Mirror((0.8,) * 3)).mean()
    assert mirror == pytest.approx(0.8)
    sharp = gloss(integrator, Phong((0.8,) * 3, 1e6), samples=16, side=32)
    assert h.mean_is(sharp, mirror * math.cos(math.pi / 4), floor=1e-3)
    dull = gloss(integrator, Phong((0.8,) * 3, 0.0), samples=4, side=16)
    assert 0 < dull.mean() < 3 * 0.8
    assert not h.mean_is(sharp, mirror)


def test_weights_of_both_ways_add_up_to_one():
    pdf, other = np.float32([1e-3, 1, 1e20, np.inf]), np.float32([5, 1, 1e-20, 2])
    together = mis.power_heuristic(pdf, other) + mis.power_heuristic(other, pdf)
    np.testing.assert_allclose(together, 1, rtol=1e-6)
