"""What every pixel filter promises (`interfaces.Filter`), checked for every class in the registry."""

import numpy as np
import pytest
from scipy import integrate

from glanz.engine.filters.blackman_harris import BlackmanHarris
from glanz.engine.interfaces import Filter
from glanz.engine.registry import FILTERS
from glanz.tests import helpers as h


def _blackman_harris(x):
    phase = 2 * np.pi * (x + 0.5)
    return 0.35875 - 0.48829 * np.cos(phase) + 0.14128 * np.cos(2 * phase) - 0.01168 * np.cos(3 * phase)


SHAPES = {"box": lambda x: np.ones_like(x), "blackman_harris": _blackman_harris}
"""Each filter's shape over [-1/2, 1/2] widths, typed here once more."""
WIDTHS = {"box": (1.0,)}

each = pytest.mark.parametrize("plugin", FILTERS.values(), ids=lambda f: f.key)


def widths(plugin):
    return WIDTHS.get(plugin.key, (1.0, 1.5, 3.0))


def check_moments(plugin):
    """Mean and second and fourth moment of the offsets against integrals of the filter's shape."""
    u = (np.arange(200_000) + 0.5) / 200_000
    shape = SHAPES[plugin.key]
    total = integrate.quad(shape, -0.5, 0.5)[0]
    for width in widths(plugin):
        x, y = plugin.offset(np.stack((u, np.roll(u, 777))), width)
        assert abs(x.mean()) <= 1e-6 * width
        assert abs(y.mean()) <= 1e-6 * width
        for power in (2, 4):
            truth = integrate.quad(lambda s, p=power: s**p * shape(s), -0.5, 0.5)[0] / total * width**power
            assert abs((x**power).mean() / truth - 1) <= 1e-3, (width, power)
            assert abs((y**power).mean() / truth - 1) <= 1e-3, (width, power)


def check_distribution(plugin):
    """B1: the cumulative distribution at offset(u) is u."""
    u = np.linspace(0, 1 - 2.0**-24, 2_001)
    shape = SHAPES[plugin.key]
    fine = np.linspace(-0.5, 0.5, 100_001)
    cdf = integrate.cumulative_trapezoid(shape(fine), fine, initial=0)
    for width in widths(plugin):
        x = plugin.offset(np.stack((u, u)), width)[0]
        assert np.abs(np.interp(x / width, fine, cdf / cdf[-1]) - u).max() <= 1e-4


def check_symmetry(plugin):
    u = np.linspace(2.0**-24, 1 - 2.0**-24, 4_001)
    for width in widths(plugin):
        there, back = plugin.offset(np.stack((u, u)), width), plugin.offset(np.stack((1 - u, 1 - u)), width)
        assert np.abs(there + back).max() <= 1e-6 * width
        assert (np.diff(there[0]) > 0).all()


@each
def test_a_filter_offers_the_interface(plugin):
    assert isinstance(plugin, Filter)
    assert FILTERS[plugin.key] is plugin
    assert plugin.__doc__.strip()


@each
def test_offsets_have_the_moments_of_the_filter(plugin):
    """Detects 1e-3 of the second and fourth moment and a shift by 1e-6 widths."""
    check_moments(plugin)


@each
def test_offsets_are_distributed_as_the_filter(plugin):
    check_distribution(plugin)


@each
def test_offsets_are_symmetric_and_increase_with_their_number(plugin):
    check_symmetry(plugin)


@each
def test_offsets_stay_within_the_width_and_keep_float32(plugin):
    u = np.array([[0, 2.0**-24, 0.5, 1 - 2.0**-24]] * 2, np.float32)
    for width in widths(plugin):
        offset = plugin.offset(u, width)
        assert offset.dtype == np.float32
        assert offset.shape == (2, 4)
        assert np.abs(offset).max() <= 0.5 * width


def _wrong_width(u2, width):
    return BlackmanHarris.offset(u2, width * 1.01)


def _hann(u2, width):
    return width * (np.arcsin(2 * u2 - 1) / np.pi)


def _shifted(u2, width):
    return BlackmanHarris.offset(u2, width) + 1e-4


@pytest.mark.parametrize(
    ("law", "offset"),
    [(check_moments, _wrong_width), (check_moments, _hann), (check_distribution, _wrong_width), (check_symmetry, _shifted)],
    ids=lambda f: f.__name__,
)
def test_the_contract_catches_a_broken_filter(law, offset):
    with pytest.raises(AssertionError):
        law(type("Mutant", (BlackmanHarris,), {"offset": staticmethod(offset)}))


@each
def test_a_filter_keeps_the_brightness_of_a_constant_picture(plugin):
    image = h.pixels(h.scene(world=0.75), h.settings(pixel_filter=plugin.key, filter_width=2.0, samples=7))
    assert np.abs(image - 0.75).max() <= 1e-7
