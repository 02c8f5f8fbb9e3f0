"""Ranges, tables and rotations against NumPy's and SciPy's own; the observer against other ways to the same colours."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from glanz.engine.maths import observer, ranges, rotations, spectrum, tables
from glanz.tests import helpers as h

N = 300


def uniform(seed, *shape):
    return np.random.default_rng(seed).random(shape)


def f32(a):
    return np.asarray(a, np.float32)


def test_progress_is_that_of_its_polynomials():
    x, low, high = uniform(1, N) * 4 - 2, -0.75, 1.25
    t = (x - low) / (high - low)
    s = np.clip(t, 0, 1)
    wanted = {
        "linear": t,
        "stepped": np.floor(t * 5) / 4,
        "smoothstep": 3 * s**2 - 2 * s**3,
        "smootherstep": 6 * s**5 - 15 * s**4 + 10 * s**3,
    }
    for name, function in ranges.PROGRESS.items():
        np.testing.assert_allclose(function(f32(x), f32(low), f32(high), f32(4)), wanted[name], atol=2e-6)


def test_there_is_no_progress_without_a_range_or_steps():
    x, one = f32([0.5, 2]), f32(1)
    for name, function in ranges.PROGRESS.items():
        assert (function(x, one, one, f32(3)) == 0).all(), name
    assert (ranges.stepped(x, f32(0), one, f32(0)) == 0).all()
    assert (ranges.stepped(x, f32(0), one, f32(-2)) == 0).all()


def test_clamps_take_their_limits_in_any_order():
    x = f32(np.linspace(-2, 2, 9))
    assert (ranges.clamped(x, f32(1), f32(-1)) == np.clip(x, -1, 1)).all()


def test_tables_are_interpolated_as_numpy_does_it():
    table, x = f32(uniform(2, 3, 20)), f32(uniform(3, N) * 1.4 - 0.2)
    places = np.linspace(0, 1, 20)
    wanted = np.stack([np.interp(x, places, row) for row in table])
    np.testing.assert_allclose(tables.look_up(table, x[None]), wanted, atol=2e-5)
    steps = table[:, np.clip(np.floor(np.clip(x, 0, 1) * f32(19)), 0, 19).astype(int)]
    assert h.same_bits(tables.look_up(table, x[None], is_smooth=False), steps)


def test_tables_go_on_as_they_end():
    table = f32([[0, 2, 3, 7]])
    found = tables.look_up(table, f32([[-1, 2, 0.5]]), goes_on=True)
    np.testing.assert_allclose(found, [[-6, 7 + 4 * 3, 2.5]], rtol=1e-6)
    assert tables.look_up(table, f32([[-1, 2]])).tolist() == [[0, 7]]


def test_vectors_turn_as_those_of_scipy():
    p, axis = 3 * h.directions(4, N, np.float32), 2 * h.directions(5, N, np.float32)
    angles = f32(uniform(6, 3, N) * 8 - 4)
    by_axis = Rotation.from_rotvec((axis / 2 * angles[0]).T)
    np.testing.assert_allclose(rotations.about(axis, angles[:1], p), by_axis.apply(p.T).T, atol=5e-6)
    by_euler = Rotation.from_euler("xyz", angles.T)
    np.testing.assert_allclose(rotations.turned(p, angles), by_euler.apply(p.T).T, atol=5e-6)
    np.testing.assert_allclose(rotations.turned(p, angles, is_inverted=True), by_euler.inv().apply(p.T).T, atol=5e-6)


def test_nothing_turns_about_no_axis():
    p = h.directions(7, N, np.float32)
    assert h.same_bits(rotations.about(np.zeros_like(p), np.ones((1, N), np.float32), p), p)


def test_turning_catches_another_order_of_axes(monkeypatch):
    right = rotations.turned
    monkeypatch.setattr(rotations, "turned", lambda p, angles, is_inverted=False: right(p[::-1], angles[::-1], is_inverted)[::-1])
    with pytest.raises(AssertionError):
        test_vectors_turn_as_those_of_scipy()


def test_the_observer_is_that_of_the_published_fit():
    """Wyman, Sloan and Shirley 2013: to 3 % of the largest value."""
    wavelengths = np.linspace(observer.SHORTEST, observer.LONGEST, observer.MATCHING.shape[1])
    assert np.abs(observer.MATCHING - spectrum._matching(wavelengths)).max() <= 0.03 * observer.MATCHING.max()
    # All three see as much of an equal-energy spectrum.
    np.testing.assert_allclose(observer.MATCHING.sum(axis=1), observer.MATCHING[1].sum(), rtol=0.001)


def test_single_wavelengths_are_of_their_colour_and_black_where_nothing_is_seen():
    red, green, blue = (observer.spectral_colour(f32([[w]]))[:, 0] for w in (620, 530, 460))
    assert red.argmax() == 0 and green.argmax() == 1 and blue.argmax() == 2
    assert (observer.spectral_colour(f32([[100, 379, 781, 5000]])) == 0).all()
    everything = observer.spectral_colour(f32([np.linspace(380, 780, 500)]))
    assert everything.min() == 0 and 0.9 <= everything.max() <= 1


def test_glows_have_luminance_one_and_go_from_red_over_white_to_blue():
    colours = observer.glow(f32([[800, 1000, 3000, 6500, 12000]]))
    # What is cut off below 0 is blue, which hardly counts.
    np.testing.assert_allclose(f32([0.2126, 0.7152, 0.0722]) @ colours[:, 2:], 1, atol=0.005)
    assert (np.diff(colours[0]) < 0).all() and (np.diff(colours[2]) >= 0).all()
    # CIE 15: a black body of 6500 K is at x = 0.3135, y = 0.3237.
    xyz = np.linalg.inv(observer.FROM_XYZ) @ colours[:, 3]
    np.testing.assert_allclose(xyz[:2] / xyz.sum(), (0.3135, 0.3237), atol=5e-4)


def test_glows_stay_what_they_are_beyond_the_table():
    edges = observer.glow(f32([[800, 12000]]))
    assert h.same_bits(observer.glow(f32([[-5, 1e9]])), edges)
