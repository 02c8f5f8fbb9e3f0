"""More samples are less noise, as fast as theory says, and noise is what it seems (catalogue H1, H2, H7, H8)."""

import numpy as np
import pytest
from scipy import stats

from glanz.engine import SAMPLERS, AreaLight, Settings
from glanz.engine.maths.hashing import mix
from glanz.engine.samplers.random import Random
from glanz.engine.samplers.stratified import Stratified
from glanz.engine.wavefront.film import Film
from glanz.tests import chance, helpers as h

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


@pytest.mark.parametrize("sampler", ["stratified", Settings().sampler])
def test_stratified_and_default_pictures_have_less_noise_than_random_ones(sampler):
    """At 64 samples less than half of it, for a smooth light."""
    assert noise(64, sampler) < 0.5 * noise(64, "random")


def single_samples(monkeypatch, scene, **changes):
    """Red of each sample of each pixel, (samples, pixels) float64; random numbers are independent."""
    batches = []
    close = Film.close

    def recording(self, is_first):
        batches.append(self.radiance[0].reshape(self._count, -1).astype(np.float64))
        close(self, is_first)

    with monkeypatch.context() as patch:
        patch.setattr(Film, "close", recording)
        h.pixels(scene, h.settings(**{"sampler": "random", "tile_size": 0, **changes}))
    return np.concatenate(batches)


def check_standard_errors_are_honest(monkeypatch):
    """H2: over 10,000 pixels z = (mean - truth) / standard error has mean 0 +- 0.05 and variance 1 +- 0.07.

    94 to 96 % of the pixels have the truth in their intervals of 95 %; Student's t of 63 degrees.
    """
    scene = h.receiver([AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 1)))], distance=0.5)
    values = single_samples(monkeypatch, scene, width=100, height=100, samples=64, max_depth=0)
    n = chance.times(64)
    assert values.shape == (n, 10_000)
    z = (values.mean(axis=0) - 0.752274688 / np.pi) / stats.sem(values, axis=0)
    assert abs(z.mean()) <= 0.05
    assert abs(z.var() - (n - 1) / (n - 3)) <= 0.07
    assert 0.94 <= (np.abs(z) <= stats.t.isf(0.025, n - 1)).mean() <= 0.96


@chance.fresh
def test_standard_errors_are_honest(monkeypatch):
    check_standard_errors_are_honest(monkeypatch)


def test_honesty_catches_samples_that_come_in_pairs_and_one_percent(monkeypatch):
    """The mutants use every random number twice, or weigh the light a little too much."""
    two = Random.two
    with monkeypatch.context() as patch:
        patch.setattr(Random, "two", staticmethod(lambda key, sample, *rest: two(key, sample // np.uint32(2), *rest)))
        with pytest.raises(AssertionError):
            check_standard_errors_are_honest(patch)
    sample = AreaLight.sample

    def brighter(k, p, u2):
        wi, distance, E, pdf = sample(k, p, u2)
        return wi, distance, E * np.float32(1.01), pdf

    monkeypatch.setattr(AreaLight, "sample", staticmethod(brighter))
    with pytest.raises(AssertionError):
        check_standard_errors_are_honest(monkeypatch)


def p_values(monkeypatch, factor=1.0):
    """Of Welch's test for each of 1,024 pixels: path tracing against path tracing without shadow rays, in a room that glows."""
    room = h.thing(h.box((-1, -1, -1), (1, 1, 1)), h.lambert(0.5, emission=0.5))
    lamp = h.thing(h.quad((0.2, 0.1, 0.9), (1.5, 0, 0), (0, 1.2, 0), name="lamp"), h.lambert(0.3, "lamp", 2.0))
    scene = h.scene([room, lamp], camera=h.PerspectiveCamera.look_at((0.1, -0.8, -0.2), (0.2, 0.5, -0.7), fov=0.8))
    settings = {"width": 32, "height": 32, "samples": 256, "max_depth": 2}
    a = single_samples(monkeypatch, scene, **settings, integrator="path", seed=1)
    b = single_samples(monkeypatch, scene, **settings, integrator="path_blind", seed=2)
    return stats.ttest_ind(a * factor, b, equal_var=False).pvalue


def uniformity(p):
    """chi2 of p-values in 20 bins."""
    return h.chi2_p(np.histogram(p, bins=20, range=(0, 1))[0], np.full(20, p.size / 20))


@chance.fresh
def test_p_values_of_two_integrators_are_uniform(monkeypatch):
    """H8 (Jung, Hanika and Dachsbacher 2020, JCGT 9(2)): no pixel differs more often than chance lets it, nor less."""
    assert uniformity(p_values(monkeypatch)) > h.ALPHA


def test_p_values_catch_two_percent(monkeypatch):
    assert uniformity(p_values(monkeypatch, 1.02)) < h.ALPHA
