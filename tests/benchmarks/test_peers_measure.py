"""What is said of Glanz beside other renderers is computed from numbers whose answer is known."""

import math

import numpy as np
import pytest

from glanz.benchmarks.peers.measure import Point, Reference, agreement, busy_share, equal_error

SHAPE, MEAN, SIGMA = (48, 48, 3), 0.5, 0.05


def render(seed, sigma=SIGMA, mean=MEAN):
    """A picture of an even grey with normal noise."""
    return mean + sigma * np.random.default_rng(seed).standard_normal(SHAPE)


def reference(seed, counts=None, **noise):
    """A `Reference` of two such pictures."""
    counts = np.ones(SHAPE[:2], bool) if counts is None else counts
    return Reference(render(seed, **noise), render(seed + 1, **noise), counts)


def point(samples, *, load=0.3, per_sample=0.01, scale=4.0, power=-1.0):
    """What an engine of known laws measures."""
    return Point(samples, load + per_sample * samples, scale * samples**power)


@pytest.mark.parametrize("power", [-1.0, -1.5, -0.75])
@pytest.mark.parametrize("samples", [16, 40, 300])
def test_time_for_an_error_is_that_of_the_samples_which_have_it(power, samples):
    found, seconds = equal_error((point(64, power=power), point(16, power=power)), point(samples, power=power).error2)
    assert abs(found / samples - 1) <= 1e-9
    assert abs(seconds - point(samples).seconds) <= 1e-9


def test_loading_does_not_grow_with_the_samples():
    """Twice the samples of a slow loader are not twice its time, as time in proportion to samples would have it."""
    _, seconds = equal_error((point(16, load=10.0), point(64, load=10.0)), point(128).error2)
    assert abs(seconds - 11.28) <= 1e-9


def test_no_picture_has_less_than_one_sample():
    samples, seconds = equal_error((point(16), point(64)), 1e3)
    assert samples == 1
    assert abs(seconds - 0.31) <= 1e-9


def test_an_error_that_does_not_fall_takes_for_ever():
    assert equal_error((point(16, power=0.1), point(64, power=0.1)), 1.0) == (math.inf, math.inf)


@pytest.mark.parametrize("error2", [0.0, -1e-6, math.nan])
def test_an_error_hidden_by_the_noise_of_the_reference_is_no_number(error2):
    assert all(map(math.isnan, equal_error((point(16), Point(64, 1.0, error2)), 1.0)))


def test_squared_error_is_that_of_the_picture_without_the_noise_of_the_reference():
    """Of 4 x 6,912 numbers it is known to 1.6 %, by six standard deviations to 10; left in, the reference's own would add 50."""
    found = np.mean([reference(10 + 20 * i).squared_error(render(20 + 20 * i)) for i in range(4)])
    assert abs(found / SIGMA**2 - 1) <= 0.1


def test_pixels_that_do_not_count_do_not_count():
    counts = np.ones(SHAPE[:2], bool)
    counts[:10] = False
    picture = render(3)
    expected = reference(1, counts).squared_error(picture)
    picture[:10] = 1e3
    assert reference(1, counts).squared_error(picture) == expected


def test_pictures_that_differ_by_noise_agree():
    for seed in range(0, 80, 4):
        found = agreement(reference(seed), reference(seed + 2, sigma=2 * SIGMA))
        assert found["agrees"], seed


@pytest.mark.parametrize("what", ["brighter", "shifted"])
def test_pictures_that_differ_by_more_than_noise_do_not_agree(what):
    """One fiftieth more light; and a pattern of 10 % of the mean to either side, which leaves the mean as it is."""
    other = reference(6)
    change = 0.02 * MEAN if what == "brighter" else 0.1 * MEAN * np.sign(np.arange(48) % 2 - 0.5)[:, None]
    changed = Reference(other.a + change, other.b + change, other.counts)
    found = agreement(reference(4), changed)
    assert not found["agrees"]
    assert abs(found["ratio"] - (1.02 if what == "brighter" else 1)) <= 5 * found["sigma"]


def test_a_process_that_waits_is_not_busy():
    assert busy_share(cpu=1.0, wall=1.0, threads=2) == 0.5
    assert busy_share(cpu=2.2, wall=1.0, threads=2) == 1.0
