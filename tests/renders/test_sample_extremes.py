"""One sample and a hundred thousand, roulette at any odds, and one sample that outshines all (catalogue H6, F7, H10, B8)."""

import math

import numpy as np
import pytest

from glanz.engine import SAMPLERS, PerspectiveCamera, PointLight
from glanz.engine.wavefront import continuation, emission
from glanz.tests import chance, helpers as h

INSIDE = PerspectiveCamera.look_at((0.3, 0.4, 0.5), (0.9, 0.8, 0.2), fov=math.radians(80))


@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize("samples", [1, 2, 17, 100_000])
def test_any_number_of_samples_keeps_what_is_constant_to_the_bit(sampler, samples):
    """H6 in a picture: the mean of 100,000 times 0.1 is 0.1, for every sampler, and so is that of 17."""
    image = h.pixels(h.scene(world=0.1), h.settings(width=1, height=1, samples=samples, sampler=sampler))
    assert (image == np.float32(0.1)).all()


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_any_number_of_samples_is_unbiased(sampler):
    """B8 in a picture: a square light by 1, 2, 3, 5, 17, and 1,000 samples is the one closed form; detects 3 %."""
    lamp = h.thing(h.quad((0, 0, 1)), h.lambert(0, "lamp", 1.0))
    for samples, side in ((1, 96), (2, 64), (3, 64), (5, 48), (17, 32), (1000, 8)):
        if sampler == "grid" and samples < 1000:
            continue  # the same numbers in every pixel: of few it is a quadrature with an error that no mean takes away
        scene = h.receiver(objects=[lamp], distance=0.5)
        image = h.pixels(scene, h.settings(width=side, height=side, samples=samples, max_depth=0, sampler=sampler))
        floor = 1e-3 if sampler == "grid" else 1e-5
        assert h.mean_is(np.pi * image[0], 0.752274688, floor=floor), samples
        assert not h.mean_is(1.03 * np.pi * image[0], 0.752274688, floor=floor), samples


def lengths(monkeypatch, r, faint=1.0):
    """Of 16,384 paths in a furnace of emission 1 and reflectance r: what each has found. Scattering and roulette alone, from the start."""
    monkeypatch.setattr(emission, "power_heuristic", lambda pdf, other: np.float32(1))
    monkeypatch.setattr(continuation, "ROULETTE_DEPTH", 0)
    monkeypatch.setattr(continuation, "FAINT", faint)
    scene = h.scene([h.thing(h.box(), h.lambert(r, "wall", 1.0))], camera=INSIDE)
    side = math.isqrt(chance.times(128 * 128))
    plan = h.plan_of(scene, h.replaced(h.settings(width=side, height=side, max_depth=1000, sampler="random"), samples=1))
    return h.pixels_of_plan(h.replaced(plan, on_surface=()))[0].ravel().astype(np.float64)


def is_analog(found, r):
    """Mean 1 / (1 - r) and variance r / (1 - r)^2 of a path that goes on with probability r and then weighs 1."""
    mean, variance = 1 / (1 - r), r / (1 - r) ** 2
    return h.mean_is(found, mean) and h.mean_is((found - mean) ** 2, variance)


@pytest.mark.parametrize("r", [0.1, 0.5, 0.9])
@chance.fresh
def test_roulette_that_leaves_every_path_its_full_weight_is_a_geometric_series(monkeypatch, r):
    """F7: a whole number for each path, with the mean and the variance of analog absorption; detects 8 and 30 % of them."""
    found = lengths(monkeypatch, r)
    np.testing.assert_allclose(found, np.round(found), rtol=1e-5)
    assert is_analog(found, r)


def test_the_variance_catches_paths_that_go_on_for_longer(monkeypatch):
    """With the threshold of the engine, a quarter, paths are longer and differ less: equal means, less variance."""
    found = lengths(monkeypatch, 0.5, faint=0.25)
    assert h.mean_is(found, 2.0)
    assert not is_analog(found, 0.5)


@pytest.mark.parametrize("r", [0.5])
def test_the_mean_catches_roulette_without_its_weight(monkeypatch, r):
    survive = continuation.survive
    monkeypatch.setattr(continuation, "survive", lambda *args: (survive(*args)[0], np.float32(1)))
    assert not is_analog(lengths(monkeypatch, r), r)


@pytest.mark.parametrize("power", [1e10, 1e20, 1e30])
def test_what_outshines_all_is_not_clamped(power):
    """H10: unless clamping is asked for, what a lamp gives is in proportion to its power up to where float32 ends."""
    weak, strong = (h.pixels(h.receiver([PointLight(position=(0.3, 0.2, 1.0), intensity=(p,) * 3)]), h.settings()) for p in (1.0, power))
    assert weak.min() > 0
    np.testing.assert_allclose(strong.astype(np.float64) / power, weak, rtol=1e-6)
