"""The film keeps every sample, and no bad one takes its pixel with it (catalogue H6)."""

from types import SimpleNamespace

import numpy as np
import pytest

from glanz.engine.passes.combined import Combined
from glanz.engine.passes.depth import Depth
from glanz.engine.passes.sample_count import SampleCount
from glanz.engine.wavefront.film import BACKGROUND, Film


def add(film, slots, L):
    """Light for the paths `slots` (M,) that lights may have sent straight to the camera."""
    film.add(None, SimpleNamespace(slot=slots), np.arange(slots.size), L, BACKGROUND, 0)


def filled(radiance, batches, pixels=3):
    """A film of `batches` batches of one sample with the same radiance in every pixel."""
    film = Film(pixels, (Combined,))
    for i in range(batches):
        film.open(1, slice(0, pixels))
        add(film, np.arange(pixels), np.full((3, pixels), radiance, np.float32))
        film.close(is_first=i == 0)
    return film


def test_a_hundred_thousand_samples_of_a_tenth_are_a_tenth():
    """H6: float64 sums, to 1e-12; the mutant in float32 would be 1e-3 off."""
    n = 100_000
    film = filled(0.1, n)
    tenth = float(np.float32(0.1))
    assert np.abs(film.sums["Combined"][:3] / n - tenth).max() <= 1e-12
    assert (film.result()["Combined"][:3] == np.float32(0.1)).all()
    mutant = np.float32(0)
    for _ in range(n):
        mutant += np.float32(0.1)
    assert abs(mutant / n - 0.1) > 1e-5


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_sample_that_is_not_finite_is_black_and_counted(bad):
    film = Film(2, (Combined,))
    film.open(4, slice(0, 2))
    L = np.ones((3, 8), np.float32)
    L[1, 5] = bad  # the third sample of pixel 1
    add(film, np.arange(8), L)
    film.close(is_first=True)
    assert film.bad_samples == 1
    assert film.result()["Combined"][:3].tolist() == [[1.0, 0.75]] * 3
    assert film.result()["Combined"][3].tolist() == [1, 1]


def test_infinities_of_both_signs_do_not_hide_each_other():
    film = Film(1, (Combined,))
    film.open(2, slice(0, 1))
    add(film, np.arange(2), np.array([[np.inf, -np.inf]] * 3, np.float32))
    film.close(is_first=True)
    assert film.bad_samples == 2
    assert film.result()["Combined"][0, 0] == 0


def test_light_of_many_places_adds_up_in_its_slot():
    film = Film(2, (Combined,))
    film.open(1, slice(0, 2))
    add(film, np.array([1]), np.full((3, 1), 2, np.float32))
    add(film, np.array([0, 1]), np.full((3, 2), 3, np.float32))
    film.close(is_first=True)
    assert film.result()["Combined"][0].tolist() == [3, 5]


def test_a_window_leaves_other_pixels_alone():
    film = Film(4, (Combined,))
    film.open(2, slice(1, 3))
    add(film, np.arange(4), np.arange(4, dtype=np.float32) + np.zeros((3, 1), np.float32))
    film.close(is_first=True)
    assert film.result()["Combined"][0].tolist() == [0, 1, 2, 0]
    assert film.result()["Combined"][3].tolist() == [0, 1, 1, 0]


def test_a_pass_of_the_first_sample_ignores_the_others():
    film = Film(1, (Depth,))
    for first in (0, 1):
        film.open(2, slice(0, 1))
        film.recorded["Depth"][0] = (7 + first, 9)
        film.close(is_first=first == 0)
    assert film.result()["Depth"].tolist() == [[7]]


def test_a_pass_of_a_sum_counts_every_sample_once():
    """Whatever the samples weigh in the mean, in whatever batches."""
    film = Film(2, (Combined, SampleCount))
    weights = np.array((1.5, 0.5, 1.0))
    for first, count in ((0, 2), (2, 1)):
        film.open(count, slice(0, 2), weights[first : first + count])
        film.close(is_first=first == 0)
    assert film.result()["Sample Count"].tolist() == [[3, 3]]
    assert film.result()["Combined"][3].tolist() == [1, 1]
