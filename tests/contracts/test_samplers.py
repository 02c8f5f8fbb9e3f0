"""What every sampler promises (`interfaces.Sampler`), checked for every class in the registry.

Promises of single samplers are in test_sampler_patterns.py. Stratification is one of several: STRATIFIED lists who makes it.
The uniform grid is the exception that chance has no part in: it is the same in every pixel, and only its mean is right.
"""

import numpy as np
import pytest

from glanz.engine.constants import ONE_MINUS_EPS32
from glanz.engine.interfaces import Sampler
from glanz.engine.maths.strata import grid
from glanz.engine.registry import SAMPLERS
from glanz.engine.samplers.blue_noise import BlueNoise
from glanz.engine.samplers.grid import Grid
from glanz.engine.samplers.multijitter import Multijitter
from glanz.engine.samplers.random import Random
from glanz.engine.samplers.sobol import Sobol
from glanz.engine.samplers.stratified import Stratified
from glanz.engine.wavefront.numbers import hashed_pixel
from glanz.tests import chance, helpers as h

STRATIFIED = (Stratified, Multijitter)
COUNTS = (1, 2, 4, 6, 12, 16, 17, 64, 1024)

each = pytest.mark.parametrize("sampler", SAMPLERS.values(), ids=lambda s: s.key)
each_random = pytest.mark.parametrize("sampler", [s for s in SAMPLERS.values() if s is not Grid], ids=lambda s: s.key)


def keys(n, seed=0, sampler=Random, apart=1):
    """Keys of n pixels in rows of 512, `apart` px from each other, as the engine makes them."""
    py, px = np.divmod(np.arange(n), 512)
    return getattr(sampler, "pixel_key", hashed_pixel)(apart * px, apart * py, apart * 512, chance.seeded(seed))


def batch(sampler, pixels, samples, dimension, seed=0, apart=1):
    """u1 (pixels, samples) and u2 (2, pixels, samples)."""
    key = np.repeat(keys(pixels, seed, sampler, apart), samples)
    sample = np.tile(np.arange(samples, dtype=np.uint32), pixels)
    one, two = sampler.one(key, sample, dimension, samples), sampler.two(key, sample, dimension, samples)
    return one.reshape(pixels, samples), two.reshape(2, pixels, samples)


def check_range(sampler):
    for samples in COUNTS:
        for dimension in (0, 3, 100):
            for u in batch(sampler, 30_000 // samples + 1, samples, dimension):
                assert u.dtype == np.float32
                assert u.min() >= 0
                assert u.max() <= np.float32(ONE_MINUS_EPS32) < 1
    # A number per pixel only, but of very many samples: the last cells are where rounding could reach 1.
    for samples in (2**24, 2**24 - 3, 10**7 + 19):
        key = keys(5_000, 0, sampler)
        sample = np.random.default_rng(1).integers(0, samples, 5_000).astype(np.uint32)
        for u in (sampler.one(key, sample, 5, samples), sampler.two(key, sample, 5, samples)):
            assert u.min() >= 0
            assert u.max() < 1


def check_order_invariance(sampler):
    """The same numbers alone, among others and in any order."""
    n = 3_000
    key, sample = keys(n, 0, sampler), np.random.default_rng(3).integers(0, 17, n).astype(np.uint32)
    order = np.random.default_rng(4).permutation(n)
    for draw in (sampler.one, sampler.two):
        u = draw(key, sample, 7, 17)
        assert h.same_bits(u, draw(key, sample, 7, 17))
        assert h.same_bits(np.ascontiguousarray(u[..., order]), draw(key[order], sample[order], 7, 17))
        for lane in (0, 1, 1234, n - 1):
            one = slice(lane, lane + 1)
            assert h.same_bits(draw(key[one], sample[one], 7, 17), u[..., one])


def check_every_sample_is_uniform(sampler):
    """chi2 over pixels, for single sample numbers: what makes the mean unbiased whatever the number of samples."""
    pixels = 50_000
    key = keys(pixels, 9, sampler)
    for samples in (1, 16, 17):
        for index in {0, samples // 2, samples - 1}:
            sample = np.full(pixels, index, np.uint32)
            u1, u2 = sampler.one(key, sample, 11, samples), sampler.two(key, sample, 11, samples)
            counts = np.histogram(u1, 64, (0, 1))[0]
            assert h.chi2_p(counts, np.full(64, pixels / 64)) > h.ALPHA, (samples, index)
            counts = np.histogram2d(*u2, bins=16, range=((0, 1), (0, 1)))[0]
            assert h.chi2_p(counts, np.full(256, pixels / 256)) > h.ALPHA, (samples, index)


def check_dimensions_are_independent(sampler):
    """chi2 of pairs of numbers of different dimensions, over pixels, each with all of its samples."""
    pixels, samples = 6_000, 16
    dimensions = (0, 1, 8, 9, 10, 11, 16)
    drawn = {d: batch(sampler, pixels, samples, d, seed=21) for d in dimensions}
    bins = np.full(256, pixels * samples / 256)
    for a in dimensions:
        for b in dimensions:
            if a < b:
                for u, v in ((drawn[a][0], drawn[b][0]), (drawn[a][0], drawn[b][1][0]), (drawn[a][1][1], drawn[b][1][0])):
                    counts = np.histogram2d(u.ravel(), v.ravel(), bins=16, range=((0, 1), (0, 1)))[0]
                    assert h.chi2_p(counts, bins) > h.ALPHA, (a, b)


def check_pixels_are_independent(sampler):
    """Correlation between the same pixel of two seeds, and between neighbours unless a sampler knows where pixels are."""
    n = 100_000
    sample = np.zeros(n, np.uint32)
    u = sampler.one(keys(n, 0, sampler), sample, 4, 16)
    neighbours = () if hasattr(sampler, "pixel_key") else (np.roll(u, 1), np.roll(u, 512))
    for other in (*neighbours, sampler.one(keys(n, 1, sampler), sample, 4, 16)):
        assert abs(np.corrcoef(u, other)[0, 1]) <= h.Z / np.sqrt(n)


@each
def test_a_sampler_offers_the_interface(sampler):
    assert isinstance(sampler, Sampler)
    assert SAMPLERS[sampler.key] is sampler
    assert sampler.__doc__.strip()


@each
def test_numbers_are_float32_from_0_to_below_1(sampler):
    check_range(sampler)


@each
def test_numbers_depend_on_nothing_but_pixel_sample_and_dimension(sampler):
    check_order_invariance(sampler)


@each_random
@chance.fresh
def test_every_single_sample_is_uniform(sampler):
    """Detects 17 % of the density in half of 64 intervals."""
    check_every_sample_is_uniform(sampler)


@each_random
@chance.fresh
def test_dimensions_are_independent(sampler):
    """Detects a correlation of 2 %."""
    check_dimensions_are_independent(sampler)


@each_random
@chance.fresh
def test_pixels_and_seeds_are_independent(sampler):
    """Detects a correlation of 1.6 %."""
    check_pixels_are_independent(sampler)


@each
@chance.fresh
def test_the_mean_is_unbiased_for_a_number_of_samples_that_makes_no_square(sampler):
    """B8: 17 samples. Detects a bias of 1.1e-3 of f = x + y."""
    _, (x, y) = batch(sampler, 20_000, 17, 3, seed=2)
    assert h.mean_is((x + y).mean(axis=1), 1.0, absolute=1e-6)


def test_the_grid_has_a_cell_for_every_sample_and_few_to_spare():
    for samples in range(1, 2_000):
        columns, rows = grid(samples)
        assert samples <= columns * rows < samples + rows
        assert rows <= columns <= 2 * rows + 1


def check_one_sample_per_cell(sampler):
    """B6: in one dimension a sample in each interval, in two a sample in each cell of the grid, in every dimension."""
    for samples in COUNTS:
        columns, rows = grid(samples)
        for dimension in (0, 9, 17, 801):
            one, (x, y) = batch(sampler, 50, samples, dimension)
            assert one_in_each(one, samples), (samples, dimension)
            if columns * rows == samples:
                # As many in each column; and within each column one in each row.
                order = np.argsort(x, axis=1)
                assert one_in_each(np.take_along_axis(x, order, 1)[:, ::rows], columns), (samples, dimension)
                assert one_in_each(np.take_along_axis(x, order, 1)[:, rows - 1 :: rows], columns), (samples, dimension)
                in_columns = np.take_along_axis(y, order, 1).reshape(-1, rows)
                assert one_in_each(in_columns, rows), (samples, dimension)
            else:
                cell = np.floor(x.astype(np.float64) * columns) + columns * np.floor(y.astype(np.float64) * rows)
                assert (np.diff(np.sort(cell, axis=1), axis=1) > 0).all(), (samples, dimension)


def one_in_each(u, cells):
    """Whether each row of u (M, cells) has one number in each of `cells` intervals, up to the rounding of float32."""
    u = np.sort(u.astype(np.float64), axis=1)
    edges = np.arange(cells + 1) / cells
    return bool((u >= edges[:-1] - 2.0**-23).all() and (u <= edges[1:] + 2.0**-23).all())


@pytest.mark.parametrize("sampler", STRATIFIED, ids=lambda s: s.key)
def test_stratified_numbers_fall_one_into_each_cell(sampler):
    check_one_sample_per_cell(sampler)


def variance_ratios(sampler, pixels=20_000, samples=64):
    """B7: variances of means over `pixels` replicates, over their closed forms for jittered sampling."""
    one, (x, y) = batch(sampler, pixels, samples, 12, seed=5, apart=256)
    n = samples
    one, x, y = one.astype(np.float64), x.astype(np.float64), y.astype(np.float64)
    return {
        "x": one.mean(axis=1).var(ddof=1) * 12 * n**3,
        "x + y": (x + y).mean(axis=1).var(ddof=1) * 6 * n**2,
        "x + y < 1": (x + y < 1).mean(axis=1).var(ddof=1) * 4 * n**1.5,
    }


def test_stratified_variance_is_that_of_the_closed_form():
    """B7: 1/(12 N^3) of x, 1/(6 N^2) of x + y, 1/(4 N^1.5) of the edge x + y < 1; within 5 %."""
    for integrand, ratio in variance_ratios(Stratified).items():
        assert abs(ratio - 1) <= 0.05, integrand


@pytest.mark.parametrize("sampler", [Multijitter, Sobol, BlueNoise], ids=lambda s: s.key)
def test_better_samplers_have_at_most_the_variance_of_the_jittered(sampler):
    """B7: as jittered for x in one dimension, no worse at edges, and a tenth of it for x + y, each coordinate being stratified.

    Sobol points come from a table of 256 scrambles, so that many replicates there are: 5 sqrt(2 / 256) = 44 %.
    """
    ratios = variance_ratios(sampler)
    assert 0.56 <= ratios["x"] <= 1.44
    assert ratios["x + y"] <= 0.1
    assert ratios["x + y < 1"] <= 1.44


def test_random_variance_is_that_of_independent_numbers():
    """B7: 1/(12 N), 1/(6 N) and 1/(4 N); within 5 %."""
    ratios = variance_ratios(Random)
    assert abs(ratios["x"] / 64**2 - 1) <= 0.05
    assert abs(ratios["x + y"] / 64 - 1) <= 0.05
    assert abs(ratios["x + y < 1"] / 64**0.5 - 1) <= 0.05


# Mutants


def mutant(base, **changes):
    return type("Mutant", (base,), {name: staticmethod(f) for name, f in changes.items()})


def _reaches_one(key, sample, dimension, samples):
    return np.minimum(Random.one(key, sample, dimension, samples) * np.float32(1.001), np.float32(1))


def _stateful(key, sample, dimension, samples):
    return np.random.default_rng(1).random(key.size, np.float32)


def _no_dimension(key, sample, dimension, samples):
    return Stratified.one(key, sample, 0, samples)


def _no_dimension_2(key, sample, dimension, samples):
    return Stratified.two(key, sample, 0, samples)


def _no_permutation(key, sample, dimension, samples):
    jitter = Random.one(key, sample, dimension, samples)
    return np.minimum((sample.astype(np.float32) + jitter) / np.float32(samples), np.float32(ONE_MINUS_EPS32))


def _no_pixel(key, sample, dimension, samples):
    return Random.one(np.zeros_like(key), sample + np.arange(key.size, dtype=np.uint32) // 8, dimension, samples)


def _half(key, sample, dimension, samples):
    return Stratified.two(key, sample, dimension, samples) * np.array([[0.999], [1.0]], np.float32)


@pytest.mark.parametrize(
    ("law", "broken"),
    [
        (check_range, mutant(Random, one=_reaches_one)),
        (check_order_invariance, mutant(Random, one=_stateful)),
        (check_every_sample_is_uniform, mutant(Stratified, one=_no_permutation)),
        (check_dimensions_are_independent, mutant(Stratified, one=_no_dimension, two=_no_dimension_2)),
        (check_pixels_are_independent, mutant(Random, one=_no_pixel)),
        (check_one_sample_per_cell, Random),
        (check_one_sample_per_cell, Sobol),
        (check_one_sample_per_cell, mutant(Stratified, two=_half)),
    ],
    ids=lambda x: getattr(x, "__name__", None),
)
def test_the_contract_catches_a_broken_sampler(law, broken):
    with pytest.raises(AssertionError):
        law(broken)


def test_the_closed_form_of_the_variance_catches_independent_numbers():
    assert all(abs(ratio - 1) > 0.05 for ratio in variance_ratios(Random).values())
