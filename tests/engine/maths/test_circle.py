"""Points on the unit circle."""

import numpy as np

from glanz.engine.maths.circle import on_circle
from glanz.tests import helpers as h


def test_points_are_where_cosine_and_sine_say():
    """In float64 to 1e-15, at steps of the table, between them and beside them; in float32 to the bit."""
    steps = np.arange(4097) / 4096
    turns = np.concatenate((h.uniform(1, 100_000)[0], steps, np.nextafter(steps[1:], 0), np.nextafter(steps[:-1], 1)))
    angle = 2 * np.pi * turns
    np.testing.assert_allclose(on_circle(turns), (np.cos(angle), np.sin(angle)), rtol=0, atol=1e-15)
    single = turns.astype(np.float32)
    for found, expected in zip(on_circle(single), (np.cos, np.sin), strict=True):
        assert found.dtype == np.float32
        assert h.same_bits(found, expected(2 * np.pi * single))


def test_what_is_no_number_stays_none():
    with np.errstate(invalid="ignore"):
        assert np.isnan(on_circle(np.array([np.nan, np.inf, 0.5]))).tolist() == [[True, True, False]] * 2
