"""Vectors on rows, frames, and the power of a cosine that float32 cannot hold."""

import numpy as np
import pytest

from glanz.engine.maths import frames, vectors
from glanz.tests import helpers as h


def test_products_are_those_of_numpy():
    a, b = h.directions(1, 500), 3 * h.directions(2, 500)
    np.testing.assert_allclose(vectors.dot(a, b), h.dots(a, b), atol=1e-15)
    np.testing.assert_allclose(vectors.cross(a, b), np.cross(a.T, b.T).T, atol=1e-15)
    np.testing.assert_allclose(vectors.length(b), 3, rtol=1e-15)
    np.testing.assert_allclose(vectors.normalize(b), b / 3, rtol=1e-14)


def test_a_zero_vector_stays_zero():
    assert (vectors.normalize(np.zeros((3, 4), np.float32)) == 0).all()


def test_a_mirror_direction_mirrors_back():
    w, n = h.directions(3, 500), h.directions(4, 500)
    r = vectors.reflect(w, n)
    np.testing.assert_allclose(vectors.dot(r, n), vectors.dot(w, n), atol=1e-14)
    np.testing.assert_allclose(vectors.reflect(r, n), w, atol=1e-14)


def test_inputs_are_not_written_to():
    a, b = h.directions(1, 10), h.directions(2, 10)
    a.flags.writeable = b.flags.writeable = False
    (
        vectors.dot(a, b),
        vectors.cross(a, b),
        vectors.normalize(a),
        vectors.reflect(a, b),
        vectors.cosine_power(a, b, 3.0),
        frames.to_world(a, b),
    )


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_dtype_is_kept(dtype):
    a, b, e = h.directions(1, 10, dtype), h.directions(2, 10, dtype), np.full(10, 3, dtype)
    for result in (vectors.dot(a, b), vectors.cross(a, b), vectors.length(a), vectors.normalize(a), vectors.reflect(a, b)):
        assert result.dtype == dtype
    assert vectors.cosine_power(a, b, e).dtype == dtype
    assert frames.to_world(a, b).dtype == dtype


C9 = 0.606530609
"""cos(1e-3)^1e6, to 9 digits: exp(-1/2) but for the fourth order, 0.60653061 (1 - 8.3e-8)."""


def power_at_a_milliradian(power, dtype):
    a, b = h.at_angle(0.4, 0.3, dtype), h.at_angle(0.401, 0.3, dtype)
    return float(power(a, b, np.full(1, 1e6, dtype))[0])


def test_a_sharp_lobe_has_its_digits():
    """C9: cos(1 mrad)^1e6 to 1e-9 in float64. In float32 to the rounding of directions, 1e6 * 1e-3 * 6e-8 = 6e-5."""
    truth = np.exp(1e6 * np.log1p(-2 * np.sin(5e-4) ** 2))
    assert truth == pytest.approx(C9, rel=1e-6)
    straight = vectors.cosine_power(h.at_angle(1e-3), h.at_angle(0.0), 1e6)
    assert straight[0] == pytest.approx(truth, rel=1e-9)
    assert power_at_a_milliradian(vectors.cosine_power, np.float64) == pytest.approx(truth, rel=1e-9)
    assert power_at_a_milliradian(vectors.cosine_power, np.float32) == pytest.approx(truth, rel=2e-4)


def test_the_sharp_lobe_catches_a_naive_power_in_float32():
    """The mutant a . b ^ n is 2.3 % off at the pole, and anything elsewhere."""
    naive = np.float32(np.cos(np.float32(1e-3))) ** np.float32(1e6)
    assert abs(naive / C9 - 1) > 0.02


@pytest.mark.parametrize("n", [0.0, 0.5, 1.0, 10.0])
def test_a_power_of_the_cosine_is_that_everywhere(n):
    a, b = h.directions(5, 5_000), h.directions(6, 5_000)
    cos = h.dots(a, b)
    truth = np.where(cos > 0, np.abs(cos) ** n, 0)
    np.testing.assert_allclose(vectors.cosine_power(a, b, n), truth, rtol=1e-12, atol=1e-12)


def check_frame(to_world):
    n, local = h.directions(7, 2_000), h.directions(8, 2_000)
    n[:, :5] = np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [0, 1, -0.0], [1e-20, 0, -1]], float).T
    world = to_world(n, local)
    np.testing.assert_allclose(h.dots(world, n), local[2], atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(world, axis=0), 1, atol=1e-14)
    x, y, z = (to_world(n, np.repeat(np.eye(3)[:, i : i + 1], 2_000, 1)) for i in range(3))
    np.testing.assert_allclose(z, n, atol=1e-14)
    np.testing.assert_allclose(np.abs(h.dots(np.cross(x.T, y.T).T, z)), 1, atol=1e-14)


def test_local_directions_turn_rigidly_about_the_normal():
    check_frame(frames.to_world)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_what_lies_along_the_axis_becomes_the_normal_to_the_bit(dtype):
    """Else sunlight at a grazing angle a is off by the share 6e-8 / a, in float32."""
    n = h.directions(7, 2_000, dtype)
    n[2, :1_000] *= dtype(1e-6)
    assert h.same_bits(frames.to_world(n, np.tile(np.array([[0], [0], [1]], dtype), 2_000)), n)
    assert h.same_bits(frames.to_world(n[:, :1], np.array([[0.0], [0.0], [1.0]])).astype(dtype), n[:, :1])


def test_rigidity_catches_a_frame_that_flips_below():
    with pytest.raises(AssertionError):
        check_frame(lambda n, local: frames.to_world(np.abs(n), local))
