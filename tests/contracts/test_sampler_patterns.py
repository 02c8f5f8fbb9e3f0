"""What single samplers promise beyond `test_samplers`: strips, elementary intervals, blue noise, slopes of the error."""

import numpy as np
import pytest
from scipy.stats import qmc

from glanz.engine import SAMPLERS, AreaLight
from glanz.engine.dimensions import Dimension, place
from glanz.engine.maths import sobol as digits
from glanz.engine.maths.hashing import mix
from glanz.engine.maths.strata import grid
from glanz.engine.samplers import sobol
from glanz.engine.samplers.blue_noise import BlueNoise
from glanz.engine.samplers.grid import Grid
from glanz.engine.samplers.multijitter import Multijitter
from glanz.engine.samplers.random import Random
from glanz.engine.samplers.sobol import Sobol
from glanz.engine.samplers.stratified import Stratified
from glanz.engine.wavefront.numbers import Numbers
from glanz.tests import helpers as h


def pixels(sampler, width, height=None, seed=0):
    """Keys (height * width,) of a picture, row by row."""
    py, px = np.divmod(np.arange(width * (height or width)), width)
    return Numbers(sampler, 1).keys(px, py, width, seed)


def two(sampler, key, samples, dimension):
    """u2 (2, keys, samples) float64."""
    sample = np.tile(np.arange(samples, dtype=np.uint32), key.size)
    return sampler.two(np.repeat(key, samples), sample, dimension, samples).reshape(2, key.size, samples).astype(np.float64)


def one_in_each(cell):
    """Whether each row of cell (M, N) has every number 0 .. N - 1 once."""
    return bool((np.sort(cell, axis=1) == np.arange(cell.shape[1])).all())


# The grid


def check_grid(sampler):
    """The same in every pixel; cells of equal area with the sample in the middle: x, y and x y are exact."""
    key = pixels(sampler, 4)
    for samples in (1, 2, 3, 7, 16, 17, 60, 1024, 5000):
        for dimension in (0, 9):
            one = sampler.one(key[:1].repeat(samples), np.arange(samples, dtype=np.uint32), dimension, samples)
            np.testing.assert_allclose(np.sort(one), (np.arange(samples) + 0.5) / samples, atol=2e-7)
            x, y = two(sampler, key, samples, dimension)
            assert (x == x[0]).all()
            assert (y == y[0]).all()
            np.testing.assert_allclose([x[0].mean(), y[0].mean(), (x * y)[0].mean()], [0.5, 0.5, 0.25], atol=2e-7)
            assert len(np.unique(y[0])) == grid(samples)[1]


def test_the_grid_is_even_and_the_same_in_every_pixel():
    check_grid(Grid)


def test_the_grid_takes_its_cells_in_another_order_in_each_dimension():
    """Else a sample's place in its pixel would choose its light: 16 samples would see 16 of 256 pairs of cells, those alike."""
    (x, _), (z, _) = (two(Grid, pixels(Grid, 1), 16, d)[:, 0] for d in (0, 8))
    assert len(set(zip(x, z))) > 4


# Multi-jittered and Sobol


def check_strips(sampler):
    """B6: no two samples share one of the columns * rows strips of x, nor of y; one in each where the grid is full."""
    key = pixels(sampler, 8)
    for samples in (1, 2, 4, 6, 12, 16, 17, 64, 1024, 8192):
        columns, rows = grid(samples)
        for dimension in (0, 9, 801):
            for u in two(sampler, key[: 1 + 4096 // samples], samples, dimension):
                # Away from the rounding of float32 at the strips' ends, in which 1e-3 of the samples lie.
                strip = u * (columns * rows)
                inside = np.abs(strip - np.round(strip)) > 2.0**-22 * samples
                strip = np.where(inside, np.floor(strip), -1 - np.arange(samples))
                assert (np.diff(np.sort(strip, axis=1), axis=1) > 0).all(), (samples, dimension)


def test_multijittered_samples_share_no_strip():
    check_strips(Multijitter)


def check_elementary_intervals(sampler):
    """In each dimension 2^k samples are a (0, k, 2)-net: one in each of the intervals 2^-a by 2^-(k - a), for all a."""
    key = pixels(sampler, 8)
    for bits in (0, 1, 2, 4, 5, 8, 10, 13):
        samples = 1 << bits
        for dimension in (0, 9, 801):
            x, y = two(sampler, key[: 1 + 4096 // samples], samples, dimension)
            for a in range(bits + 1):
                cell = np.floor(x * 2**a) * 2 ** (bits - a) + np.floor(y * 2 ** (bits - a))
                assert one_in_each(cell), (samples, dimension, a)


@pytest.mark.parametrize("sampler", [Sobol, BlueNoise], ids=lambda s: s.key)
def test_powers_of_two_have_one_sample_in_each_elementary_interval(sampler):
    check_elementary_intervals(sampler)


NEAR = [place(d, depth) for d in (Dimension.LIGHT, Dimension.DIRECTION) for depth in (0, 1)] + [place(Dimension.LENS)]


def check_nearly_as_even(dimension):
    """2^k samples are a (2, k, 2)-net: four in each elementary interval of four times their share of the area."""
    key = pixels(Sobol, 8)
    for bits in range(2, 13):
        x, y = two(Sobol, key[: 1 + 256 // (1 << bits)], 1 << bits, dimension)
        for a in range(bits - 1):
            cell = np.sort(np.floor(x * 2**a) * 2 ** (bits - 2 - a) + np.floor(y * 2 ** (bits - 2 - a)), axis=1)
            assert one_in_each(cell[:, ::4]), (bits, a)
            assert one_in_each(cell[:, 3::4]), (bits, a)


@pytest.mark.parametrize("dimension", NEAR)
def test_lens_lights_and_directions_are_nearly_as_even_as_places_in_the_pixel(dimension):
    check_nearly_as_even(dimension)


def test_axes_that_are_not_nearly_as_even_are_noticed(monkeypatch):
    """Those that follow each other: of 256 points sixteen may share an interval with room for one."""
    monkeypatch.setitem(sobol._AXES, place(Dimension.LENS), (11, 12))
    with pytest.raises(AssertionError):
        check_nearly_as_even(place(Dimension.LENS))


@pytest.mark.parametrize("sampler", [Sobol, BlueNoise], ids=lambda s: s.key)
def test_the_first_samples_of_a_power_of_two_are_spread_as_well(sampler):
    """17 samples are the beginning of 32: their first 16, 8 and 4 are nets."""
    x, y = two(sampler, pixels(sampler, 16), 17, 3)
    for bits in (2, 3, 4):
        for a in range(bits + 1):
            cell = np.floor(x * 2**a) * 2 ** (bits - a) + np.floor(y * 2 ** (bits - a))
            assert one_in_each(cell[:, : 1 << bits])


def test_the_axes_are_those_of_the_direction_numbers():
    """Points 0 .. 1023 of SciPy's sequence (Joe and Kuo 2008), which comes in the order of Gray's code."""
    coordinates = [digits.reverse_bits(digits._mirrored(np.arange(1024, dtype=np.uint32), axis)) for axis in range(digits.AXES)]
    theirs = qmc.Sobol(digits.AXES, scramble=False, bits=32).random(1024) * 2**32
    gray = np.arange(1024) ^ np.arange(1024) >> 1
    assert (np.array(coordinates)[:, gray] == theirs.T).all()


def test_each_axis_has_one_point_in_each_interval():
    """Scrambled and in any order, also far beyond the first indices."""
    index = np.arange(3 << 20, (3 << 20) + 1024, dtype=np.uint32)
    for axis, row in enumerate(digits.points(index, np.full(1024, 77, np.uint32), range(digits.AXES))):
        assert np.unique(row >> np.uint32(22)).size == 1024, axis


def interactions(sampler, samples):
    """RMSE over 2,000 pixels of the mean of products of numbers of two dimensions that matter in most pictures, 0 in truth: worst."""
    key = np.concatenate([pixels(sampler, 20, seed=seed) for seed in range(5)])
    pixel, light, way = (two(sampler, key, samples, d) - 0.5 for d in (Dimension.FILTER, Dimension.LIGHT, Dimension.DIRECTION))
    pairs = ((pixel, light), (pixel, way), (light, way))
    return max(np.sqrt(np.mean((a[i] * b[j]).mean(axis=1) ** 2)) for a, b in pairs for i in (0, 1) for j in (0, 1))


@pytest.mark.parametrize("samples", [256, 1024, 2048, 8192])
def test_the_numbers_that_matter_most_complement_each_other(samples):
    """A product of two even but independent numbers is off by 1 / (12 sqrt(N)); drawn together, by less than half of that."""
    assert interactions(Sobol, samples) < 0.5 / 12 / np.sqrt(samples)


def test_numbers_that_are_drawn_apart_do_not(monkeypatch):
    monkeypatch.setattr("glanz.engine.samplers.sobol._AXES", {})
    assert interactions(Sobol, 1024) > 0.8 / 12 / np.sqrt(1024)


def test_reversing_bits_mirrors_them():
    x = np.array([0, 1, 0x80000000, 0x12345678, 0xFFFF0001], np.uint32)
    assert [int(f"{int(v):032b}"[::-1], 2) for v in x] == digits.reverse_bits(x).tolist()


def test_an_owen_scramble_flips_bits_depending_on_lower_ones_only():
    """And half of the bits above: each bit's flip by another bit within 0.5 +- 0.05, over keys."""
    key = mix(np.arange(20_000, dtype=np.uint32))
    x = mix(key)
    for bit in range(31):
        changed = digits.owen(x, key) ^ digits.owen(x ^ np.uint32(1 << bit), key)
        flips = np.array([((changed >> np.uint32(b)) & np.uint32(1)).mean() for b in range(32)])
        assert (flips[:bit] == 0).all()
        assert flips[bit] == 1
        assert np.abs(flips[bit + 1 :] - 0.5).max() <= 0.05, bit


# Blue noise

SIDE = 128
LOW = 16
"""Frequencies of up to SIDE / LOW cycles in the picture: features of at least LOW pixels."""


def low_frequencies(sampler, samples, f):
    """Mean power of the error of f(x, y) at low frequencies, over dimensions and seeds, times samples."""
    frequency = np.fft.fftfreq(SIDE, 1 / SIDE)
    radius = np.hypot(*np.meshgrid(frequency, frequency))
    low = (radius > 0) & (radius <= SIDE / LOW)
    power = []
    for seed in range(4):
        for dimension in (0, 8, 10):
            error = f(*two(sampler, pixels(sampler, SIDE, seed=seed), samples, dimension)).mean(axis=1).reshape(SIDE, SIDE)
            power.append((np.abs(np.fft.fft2(error - error.mean())) ** 2)[low].mean() / SIDE**2)
    return np.mean(power)


SHADING = {"smooth": lambda x, y: np.exp(x + y), "edge": lambda x, y: (x + y < 1) * 1.0, "one coordinate": lambda x, y: x}


def check_blue_noise(sampler):
    """At low frequencies at most 6 % of the power of random numbers at one sample for smooth light, 30 % for edges.

    At four samples likewise, against the Sobol sampler: what is gained between pixels comes on top of what is within.
    """
    for samples, other in ((1, Random), (4, Sobol)):
        for name, bound in (("smooth", 0.06), ("one coordinate", 0.06), ("edge", 0.3)):
            f = SHADING[name]
            assert low_frequencies(sampler, samples, f) <= bound * low_frequencies(other, samples, f), (samples, name)


def test_blue_noise_has_little_error_at_low_frequencies():
    check_blue_noise(BlueNoise)


def check_no_direction():
    """Neighbours left and right are as unlike as those above and below: correlations within 0.05 of each other."""
    across, down = [], []
    for seed in range(4):
        error = two(BlueNoise, pixels(BlueNoise, SIDE, seed=seed), 1, 8)[0, :, 0].reshape(SIDE, SIDE) - 0.5
        across.append((error[:, 1:] * error[:, :-1]).mean() * 12)
        down.append((error[1:] * error[:-1]).mean() * 12)
    assert abs(np.mean(across) - np.mean(down)) <= 0.05
    assert np.mean(across) < -0.1


def test_blue_noise_has_no_direction():
    check_no_direction()


def test_the_direction_of_blue_noise_catches_quads_that_are_never_turned(monkeypatch):
    monkeypatch.setattr("glanz.engine.samplers.blue_noise._turned", lambda place, block: place)
    with pytest.raises(AssertionError):
        check_no_direction()


def test_the_keys_of_blue_noise_tell_all_pixels_of_a_block_apart():
    assert np.unique(pixels(BlueNoise, 256)).size == 256**2
    assert np.unique(pixels(BlueNoise, 1024, 512)).size > 0.999 * 1024 * 512


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_a_picture_depends_neither_on_tiles_nor_on_its_border(sampler):
    """H3, across a block of blue noise too: its pixels are known by their place in the full frame."""
    scene = h.receiver([AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 1)))], distance=0.5)
    settings = h.settings(width=264, height=12, samples=2, max_depth=0, sampler=sampler)
    whole = h.pixels(scene, settings)
    assert h.same_bits(h.pixels(scene, h.replaced(settings, tile_size=5, threads=2)), whole)
    assert h.same_bits(h.pixels(scene, h.replaced(settings, border=(250, 3, 261, 9))), whole[:, 3:9, 250:261])
    if sampler != "grid":
        assert not h.same_bits(h.pixels(scene, h.replaced(settings, seed=1)), whole)


# H1

COUNTS = np.array((4, 16, 64, 256, 1024, 4096))
INTEGRANDS = {
    "smooth": (lambda x, y: np.exp(x + y), (np.e - 1) ** 2),
    "edge": (lambda x, y: (x + y < 1) * 1.0, 0.5),
}
SLOPES = {
    ("multijitter", "smooth"): (-0.9, -0.7),
    ("sobol", "smooth"): (-1.55, -1.35),
    ("blue_noise", "smooth"): (-1.55, -1.35),
    ("multijitter", "edge"): (-0.85, -0.7),
    ("sobol", "edge"): (-0.85, -0.7),
    ("blue_noise", "edge"): (-0.85, -0.7),
    ("stratified", "smooth"): (-1.05, -0.95),
    ("stratified", "edge"): (-0.8, -0.7),
    ("random", "smooth"): (-0.55, -0.45),
    ("random", "edge"): (-0.55, -0.45),
}


def slope(sampler, integrand):
    """Slope of log RMSE over log N, 4 .. 4096, 256 replicates with seeds of their own; the truth is known."""
    f, truth = INTEGRANDS[integrand]
    key = np.concatenate([pixels(sampler, 1, seed=seed) for seed in range(256)])
    errors = [np.sqrt(np.mean((f(*two(sampler, key, int(n), 9)).mean(axis=1) - truth) ** 2)) for n in COUNTS]
    return np.polyfit(np.log(COUNTS), np.log(errors), 1)[0]


@pytest.mark.parametrize(("sampler", "integrand"), SLOPES, ids="-".join)
def test_error_falls_as_theory_says(sampler, integrand):
    """H1: -1/2 at random, -1 jittered, -3/2 (log N)^1/2 Owen-scrambled (Owen 1997) for smooth functions; -3/4 at edges.

    Correlated multi-jittering: -3/2 for sums f(x) + g(y) but -3/4 for exp(x + y), from below the jittered up to 200 samples.
    The permutation is the same for all columns, so its error averages over rows only: (1 / columns) / sqrt(rows).
    """
    low, high = SLOPES[sampler, integrand]
    assert low <= slope(SAMPLERS[sampler], integrand) <= high


# Mutants


def mutant(base, function):
    return type("Mutant", (base,), {"two": staticmethod(function)})


def _no_second_dimension(key, sample, dimension, samples):
    u2 = Sobol.two(key, sample, dimension, samples)
    return u2[[0, 0]]


def _rotated(key, sample, dimension, samples):
    u2 = Sobol.two(key, sample, dimension, samples)
    return (u2 + np.float32(0.3)) % np.float32(1)


@pytest.mark.parametrize(
    ("law", "broken"),
    [
        (check_grid, Stratified),
        (check_strips, Stratified),
        (check_elementary_intervals, mutant(Sobol, _no_second_dimension)),
        (check_elementary_intervals, mutant(Sobol, _rotated)),
        (check_elementary_intervals, Multijitter),
        (check_blue_noise, Sobol),
    ],
    ids=lambda x: getattr(x, "__name__", None),
)
def test_the_laws_catch_a_broken_sampler(law, broken):
    with pytest.raises(AssertionError):
        law(broken)


def test_the_slope_tells_samplers_apart():
    assert slope(Stratified, "smooth") > -1.1 > -1.3 > slope(Sobol, "smooth")
