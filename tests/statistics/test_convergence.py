"""More samples are less noise, as fast as theory says, and noise is what it seems (catalogue H1, H2, H7)."""

import numpy as np
import pytest

from glanz.engine import SAMPLERS, AreaLight
from glanz.engine.maths.hashing import mix
from glanz.engine.samplers.random import Random
from glanz.engine.samplers.stratified import Stratified
from glanz.tests import helpers as h

COUNTS = np.array((4, 16, 64, 256, 1024))
REPLICATES = 400
INTEGRANDS = {
    "smooth": (lambda x, y: np.exp(x + y), (np.e - 1) ** 2),
    "edge": (lambda x, y: (x + y < 1).astype(float), 0.5),
}
SLOPES = {("random", "smooth"): -0.5, ("random", "edge"): -0.5, ("stratified", "smooth"): -1.0, ("stratified", "edge"): -0.75}


def slope(sampler, integrand):
    """Slope of log RMSE over log N, over REPLICATES pixels; the truth is known, so it never flattens."""
    f, truth = INTEGRANDS[integrand]
    errors = []
    for n in COUNTS:
        key = np.repeat(mix(np.arange(REPLICATES, dtype=np.uint32)), n)
        u2 = sampler.two(key, np.tile(np.arange(n, dtype=np.uint32), REPLICATES), 9, int(n)).astype(np.float64)
        errors.append(np.sqrt(np.mean((f(*u2).reshape(REPLICATES, n).mean(axis=1) - truth) ** 2)))
    return np.polyfit(np.log(COUNTS), np.log(errors), 1)[0]


@pytest.mark.parametrize(("sampler", "integrand"), SLOPES, ids="-".join)
def test_error_falls_as_theory_says(sampler, integrand):
    """H1: -1/2 at random; stratified -1 for smooth functions and -3/4 for edges; within 0.05."""
    assert slope(SAMPLERS[sampler], integrand) == pytest.approx(SLOPES[sampler, integrand], abs=0.05)


def test_the_slope_tells_the_samplers_apart():
    assert abs(slope(Random, "smooth") - slope(Stratified, "smooth")) > 0.3


def noise(samples, sampler, seed=0):
    """RMSE over the pixels that see one point under a square light."""
    scene = h.receiver([AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 1)))], distance=0.5)
    image = h.pixels(scene, h.settings(width=32, height=32, samples=samples, max_depth=0, sampler=sampler, seed=seed))
    return np.sqrt(np.mean((image[0].astype(np.float64) - 0.752274688 / np.pi) ** 2))


@pytest.mark.parametrize("sampler", ["random", "stratified"])
def test_four_times_the_samples_are_at_most_half_the_error(sampler):
    """H7 for a picture: 2.0 +- 0.15 at random, more when stratified."""
    ratios = [noise(n, sampler) / noise(4 * n, sampler) for n in (4, 16, 64)]
    if sampler == "random":
        np.testing.assert_allclose(ratios, 2.0, atol=0.25)
    else:
        assert min(ratios) > 1.9


def test_stratified_pictures_have_less_noise_than_random_ones():
    """At 64 samples less than half of it, for a smooth light."""
    assert noise(64, "stratified") < 0.5 * noise(64, "random")


def test_the_noise_between_pixels_is_the_error_of_a_pixel():
    """H2: with random numbers the deviation from the truth over pixels, in standard errors, has variance 1."""
    scene = h.receiver([AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 1)))], distance=0.5)
    images = [
        h.pixels(scene, h.settings(width=16, height=16, samples=16, max_depth=0, sampler="random", seed=s))[0].astype(np.float64)
        for s in range(20)
    ]
    z = (np.mean(images, axis=0) - 0.752274688 / np.pi) / (np.std(images, axis=0, ddof=1) / np.sqrt(20))
    assert abs(z.mean()) <= 5 / 16
    assert z.var() == pytest.approx(19 / 17, abs=0.5)  # Student's t of 19 degrees
