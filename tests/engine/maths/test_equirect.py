"""Directions as places of an equirectangular picture, and back (catalogue B1, B3)."""

import numpy as np
import pytest

from glanz.engine.maths import equirect
from glanz.tests import helpers as h


@pytest.mark.parametrize(
    ("d", "u", "v"),
    [
        ((1, 0, 0), 0.5, 0.5),
        ((0, 1, 0), 0.25, 0.5),
        ((0, -1, 0), 0.75, 0.5),
        ((0, 0, 1), 0.5, 0),
        ((0, 0, -1), 0.5, 1),
        ((1, 0, 1), 0.5, 0.25),
    ],
)
def test_the_picture_is_turned_as_in_blender(d, u, v):
    np.testing.assert_allclose(np.array(equirect.direction_to_square(h.unit(*d))).ravel(), (u, v), atol=1e-15)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_directions_come_back(dtype):
    """Also 1e-6 from a pole, where acos would lose half of the digits."""
    eps = np.finfo(dtype).eps
    d = np.concatenate((h.directions(1, 10_000, dtype), h.at_angle(1e-6, 2.0, dtype), h.at_angle(np.pi - 1e-6, 2.0, dtype)), axis=1)
    u, v = equirect.direction_to_square(d)
    assert u.dtype == v.dtype == dtype
    assert min(u.min(), v.min()) >= 0
    assert max(u.max(), v.max()) <= 1
    back = equirect.square_to_direction(u, v)
    assert back.dtype == dtype
    assert np.abs(back - d).max() <= 8 * eps
    assert np.abs(np.linalg.norm(back.astype(float), axis=0) - 1).max() <= 8 * eps


def test_the_density_covers_the_sphere():
    """B3: the mean of 1 / pdf over the square is 4 pi, and it stays finite at the poles."""
    v = (np.arange(10_000) + 0.5) / 10_000
    assert (1 / equirect.square_to_direction_pdf(v)).mean() == pytest.approx(4 * np.pi, rel=1e-7)
    assert np.isfinite(equirect.square_to_direction_pdf(np.array([0, 1], np.float32))).all()
