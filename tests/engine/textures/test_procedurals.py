"""Checker and gradient against twins that know no arrays, and the checker's average against quadrature."""

import math

import numpy as np
import pytest

from glanz.engine import CheckerTexture, GradientTexture
from glanz.engine.textures import checker
from glanz.engine.textures.checker import mean_sign
from glanz.tests.contracts.test_textures import Points, somewhere


def test_a_checker_is_odd_where_an_odd_number_of_coordinates_is():
    p = somewhere()
    value = CheckerTexture((1.0, 0.5, 0.0), (0.0, 0.25, 1.0))
    found = value.eval(Points(p))
    for point, colour in zip(p.T[:500], found.T):
        x, y, z = (math.floor((float(c) + 1e-6) * 0.999999) for c in point)
        assert colour.tolist() == list(value.odd if (x + y + z) % 2 else value.even)


def test_a_surface_at_a_whole_number_is_on_one_side():
    """Blender's shift: z = 0 up to rounding is the cube above."""
    p = somewhere()
    p[2] = 0
    above = p.copy()
    above[2] = 0.5
    wobbling = p.copy()
    wobbling[2] = np.where(np.arange(p.shape[1]) % 2, np.float32(-1e-7), np.float32(1e-7))
    value = CheckerTexture()
    expected = value.eval(Points(above))
    for q in (p, wobbling):
        assert np.array_equal(value.eval(Points(q)), expected)


@pytest.mark.parametrize("half", [0.0, 1e-4, 0.1, 0.4999, 0.5001, 0.75, 1.0, 3.3, 200.0])
def test_the_mean_of_the_sign_is_its_integral(half):
    """Against the exact sum over the unit intervals that [x - half, x + half] cuts."""
    x = np.linspace(-3.3, 4.1, 101)
    for value, found in zip(x, mean_sign(x.astype(np.float32), np.full(x.shape, half, np.float32))):
        low, high = float(np.float32(value)) - half, float(np.float32(value)) + half
        if half == 0:
            assert found == (-1) ** math.floor(value)
            continue
        total = 0.0
        for i in range(math.floor(low), math.floor(high) + 1):
            total += (-1) ** i * max(min(high, i + 1) - max(low, i), 0)
        assert abs(found - total / (2 * half)) <= max(2e-3 if half == 1e-4 else 2e-6, 4e-5 / max(half, 1))


def test_integrals_catch_a_triangle_wave_of_another_phase(monkeypatch):
    wave = checker._triangle_wave
    monkeypatch.setattr(checker, "_triangle_wave", lambda x: wave(x + np.float32(0.1)))
    with pytest.raises(AssertionError):
        test_the_mean_of_the_sign_is_its_integral(0.75)


def twin_gradient(shape, x, y, z):
    r = math.sqrt(x * x + y * y + z * z)
    t = min(max(x, 0), 1)
    value = {
        "linear": x,
        "quadratic": max(x, 0) ** 2,
        "easing": 3 * t**2 - 2 * t**3,
        "diagonal": (x + y) / 2,
        "radial": math.atan2(y, x) / (2 * math.pi) + 0.5,
        "spherical": max(0.999999 - r, 0),
        "quadratic sphere": max(0.999999 - r, 0) ** 2,
    }[shape]
    return min(max(value, 0), 1)


@pytest.mark.parametrize("shape", ["linear", "quadratic", "easing", "diagonal", "radial", "spherical", "quadratic sphere"])
def test_gradients_are_those_of_the_twin(shape):
    p = somewhere(scale=2.0)
    expected = [twin_gradient(shape, *map(float, q)) for q in p.T]
    found = GradientTexture(shape).eval(Points(p))
    assert np.abs(found - expected).max() <= 1e-6
    assert len(set(expected)) > 10
