"""What every pixel filter promises (`interfaces.Filter`), checked for every class in the registry."""

import numpy as np
import pytest
from scipy import integrate

from glanz.engine import OrthographicCamera, prepare, render_image, render_plan
from glanz.engine.filters.blackman_harris import BlackmanHarris
from glanz.engine.filters.mitchell import Mitchell
from glanz.engine.interfaces import Filter
from glanz.engine.registry import FILTERS
from glanz.engine.wavefront import signed_filter
from glanz.engine.wavefront.film import Film, shown
from glanz.tests import helpers as h


def _blackman_harris(x):
    phase = 2 * np.pi * (x + 0.5)
    return 0.35875 - 0.48829 * np.cos(phase) + 0.14128 * np.cos(2 * phase) - 0.01168 * np.cos(3 * phase)


def _mitchell(s):
    """Mitchell and Netravali 1988, equation 8, with B and C as they stand there."""
    x, b, c = 4 * np.abs(s), 1 / 3, 1 / 3
    near = (12 - 9 * b - 6 * c) * x**3 + (-18 + 12 * b + 6 * c) * x**2 + (6 - 2 * b)
    far = (-b - 6 * c) * x**3 + (6 * b + 30 * c) * x**2 + (-12 * b - 48 * c) * x + (8 * b + 24 * c)
    return np.where(x < 1, near, far) / 6


SHAPES = {
    "box": lambda x: np.ones_like(x),
    "blackman_harris": _blackman_harris,
    "tent": lambda x: 1 - 2 * np.abs(x),
    "gaussian": lambda x: np.exp(-((6 * x) ** 2) / 2) - np.exp(-4.5),
}
"""Each filter's shape over [-1/2, 1/2] widths, typed here once more."""
WIDTHS = {"box": (1.0,)}

each = pytest.mark.parametrize("plugin", FILTERS.values(), ids=lambda f: f.key)
each_positive = pytest.mark.parametrize("plugin", [FILTERS[key] for key in SHAPES], ids=lambda f: f.key)


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


@each_positive
def test_offsets_have_the_moments_of_the_filter(plugin):
    """Detects 1e-3 of the second and fourth moment and a shift by 1e-6 widths."""
    check_moments(plugin)


@each_positive
def test_offsets_are_distributed_as_the_filter(plugin):
    check_distribution(plugin)


@each_positive
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


# Negative lobes


def test_every_filter_is_held_to_its_shape():
    """By the laws above, or by those below for what has negative lobes."""
    assert set(FILTERS) == set(SHAPES) | {f.key for f in FILTERS.values() if hasattr(f, "negative_mass")}


def check_signed_moments(plugin, samples=400):
    """Weighted moments of all samples of many pixels against integrals of the filter, which is negative in places."""
    # Fine in the number that chooses: lobe meets lobe in one of 900 cases.
    u = (np.indices((8192, 96)).reshape(2, -1) + 0.5) / np.array([[8192], [96]])
    weights = signed_filter.sample_weights(plugin, (samples,))
    assert weights.min() < 0
    assert abs(weights.mean() - 1) <= 1e-12
    negative = signed_filter.negative_samples(plugin, (samples,))
    assert ((weights < 0) == negative).all()
    mass = -weights[negative].sum() / samples
    points = np.concatenate((plugin.offset(u, 4.0), plugin.negative_offset(u, 4.0)), axis=1)
    weight = np.repeat((1 + mass, -mass), u.shape[1]) / u.shape[1]

    def truth(f):
        return integrate.quad(lambda x: _mitchell(x / 4) * f(x), -2, 2, points=(-1, 1, -8 / 7, 8 / 7))[0]

    for f in (np.ones_like, np.square, lambda x: x**4, np.cos, lambda x: np.cos(4 * x), lambda x: np.abs(x) < 1.3):
        for g in (np.ones_like, np.cos):
            x, y = points
            assert abs((weight * f(x) * g(y)).sum() - truth(f) * truth(g)) <= 2e-3
            assert abs((weight * f(y) * g(x)).sum() - truth(f) * truth(g)) <= 2e-3
    assert np.abs((weight * points).sum(axis=1)).max() <= 1e-3


def test_signed_samples_have_the_moments_of_the_filter():
    """B5 for a filter with negative lobes: second and fourth moment, two frequencies, an edge; in x, in y, and jointly."""
    check_signed_moments(Mitchell)


def _hills_only(u2, width):
    return Mitchell.offset(u2 * np.array([[0.99], [1.0]]), width)


@pytest.mark.parametrize(
    "changes",
    [{"offset": staticmethod(_hills_only)}, {"negative_mass": 0.06}, {"negative_offset": Mitchell.offset}],
    ids=lambda c: next(iter(c)),
)
def test_the_signed_moments_catch_a_broken_filter(changes):
    with pytest.raises(AssertionError):
        check_signed_moments(type("Mutant", (Mitchell,), changes))


def test_the_lobes_get_their_share_of_any_number_of_samples():
    for samples in (1, 2, 7, 8, 17, 64, 1000, 4096):
        negative = signed_filter.negative_samples(Mitchell, (samples,))
        assert negative.size == samples
        assert abs(negative.sum() - samples * 0.0633) <= 0.51
        if samples > 100:  # spread evenly, so unfinished pictures are right too
            assert abs(negative[: samples // 4].sum() - negative.sum() / 4) <= 1
    assert signed_filter.sample_weights(BlackmanHarris, (64,)).size == 0


def test_the_lobes_get_their_share_of_every_replicate():
    """Also of a last one that is not whole, of larger ones, and where there are too few samples for lobes."""
    for sizes in ((16,) * 4, (16,) * 6 + (4,), (4, 4, 1), (32, 1), (16, 16, 64, 64)):
        weights, negative = signed_filter.sample_weights(Mitchell, sizes), signed_filter.negative_samples(Mitchell, sizes)
        assert negative.size == sum(sizes)
        parts = zip(sizes, np.split(weights, np.cumsum(sizes)[:-1]), strict=True) if weights.size else ()
        for size, part in parts:
            assert part.mean() == pytest.approx(1, abs=1e-12)
            assert abs((part < 0).sum() - size * 0.0633) <= 0.51


@pytest.mark.parametrize("samples", [1, 7, 8, 100])
def test_signed_weights_leave_a_constant_picture_and_alpha_alone(samples):
    """No noise from signs, whatever the batches: alpha is 1."""
    settings = h.settings(pixel_filter="mitchell", filter_width=4.0, samples=samples, sampler="random", max_depth=3)
    image = render_image(h.scene(world=0.75), settings).passes["Combined"]
    assert np.abs(image[..., :3] - 0.75).max() <= 3e-7
    assert np.abs(image[..., 3] - 1).max() <= 3e-7


def unfinished(**settings):
    """The pictures (pixels, 4) after 1, 2, 4, ... of 64 samples of an even world of 0.75."""
    asked = h.settings(pixel_filter="mitchell", filter_width=4.0, samples=64, width=4, height=4, **settings)
    plan, _ = prepare(h.scene(world=0.75), asked)
    begin, end = asked.rendered_samples
    tiles = [tile for progress in render_plan(plan, range(begin + 1, end)) for tile in progress.tiles]
    assert [tile.is_final for tile in tiles] == [False] * (end - begin - 1) + [True]
    return [tile.passes["Combined"].reshape(-1, 4) for tile in tiles]


def test_unfinished_pictures_are_as_bright_as_finished_ones():
    for picture in unfinished():
        np.testing.assert_allclose(picture, np.tile((0.75, 0.75, 0.75, 1), (16, 1)), atol=3e-7)


def test_of_samples_that_begin_with_a_negative_one_nothing_is_divided_by_next_to_nothing():
    sizes = h.settings(samples=64).replicate_sizes
    first = int(np.argmax(signed_filter.negative_samples(Mitchell, sizes)))
    weights = signed_filter.sample_weights(Mitchell, sizes)[first : first + 4]
    assert abs(weights[:2].sum()) < 0.2
    pictures = unfinished(sample_range=(first, first + 4))
    for picture, mean in zip(pictures[:2], np.cumsum(weights)[:2] / (1, 2), strict=True):
        np.testing.assert_allclose(picture[:, 3], mean, atol=3e-7)


def test_unfinished_pictures_that_count_samples_would_be_seen_here(monkeypatch):
    monkeypatch.setattr(Film, "result", lambda film, is_whole: shown(film.passes, film.pixels()))
    assert max(picture[:, 3].max() for picture in unfinished()) > 1.05


def test_an_edge_rings_as_the_filter_says():
    """A half plane of light: pixels are the integral of the filter beyond the edge, below 0 and above 1 beside it."""
    lit = h.thing(h.quad((2, 0, 0), (4, 0, 0), (0, 4, 0), name="lit"), h.lambert(0.0, "light", emission=1.0))
    camera = OrthographicCamera.look_at((0, 0, 1), (0, 0, 0), up=(0, 1, 0), height=1.6)
    settings = h.settings(width=16, height=16, samples=512, pixel_filter="mitchell", filter_width=4.0, sampler="sobol")
    columns = h.pixels(h.scene([lit], camera=camera), settings)[0].astype(float).mean(axis=0)
    edge = np.arange(16) + 0.5 - 8
    fine = np.linspace(-2, 2, 40_001)
    cdf = integrate.cumulative_trapezoid(_mitchell(fine / 4), fine, initial=0)
    truth = np.interp(edge, fine, cdf)
    assert truth.min() < -0.007 < 1.007 < truth.max()
    assert np.abs(columns - truth).max() <= 4e-3


@each
def test_a_filter_keeps_the_brightness_of_a_constant_picture(plugin):
    image = h.pixels(h.scene(world=0.75), h.settings(pixel_filter=plugin.key, filter_width=2.0, samples=7))
    assert np.abs(image - 0.75).max() <= 1e-7
