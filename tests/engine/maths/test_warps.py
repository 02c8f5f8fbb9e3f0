"""Warps put equal areas where their densities say: inverse distributions, moments, integrals (catalogue B1-B5, B11)."""

from fractions import Fraction

import numpy as np
import pytest
from scipy import stats

from glanz.engine.lights.point import PointLight
from glanz.engine.maths import warps
from glanz.tests import chance, helpers as h

EXPONENTS = (0.0, 0.5, 1.0, 10.0, 1e3, 1e6)
U = np.concatenate(([0.0, 2.0**-53, 1 - 2.0**-53], np.linspace(0.001, 0.999, 500)))
U2 = np.stack(np.meshgrid(U, U[::17])).reshape(2, -1)
N = 1_000_000


def one_minus_cos(w):
    """1 - cos of the angle to +z, without cancellation."""
    sin2 = w[0] ** 2 + w[1] ** 2
    return np.where(w[2] > 0.5, sin2 / (1 + np.sqrt(np.maximum(1 - sin2, 0))), 1 - w[2])


def turn(w):
    """Azimuth as a share of the full turn, in [0, 1)."""
    return np.mod(np.arctan2(w[1], w[0]) / (2 * np.pi), 1.0)


def check_inverse_distribution(warp, cdf, tolerance=1e-12):
    """B1: cdf(warp(u)) = u in both numbers."""
    w = warp(U2)
    assert np.abs(cdf(w) - U2[0]).max() <= tolerance
    off_axis = np.hypot(w[0], w[1]) > 0
    difference = np.abs(turn(w) - U2[1])[off_axis]
    assert np.minimum(difference, 1 - difference).max() <= tolerance


DISTRIBUTIONS = {
    "disk": (warps.square_to_disk, lambda w: w[0] ** 2 + w[1] ** 2),
    "cosine hemisphere": (warps.square_to_cosine_hemisphere, lambda w: w[0] ** 2 + w[1] ** 2),
    "uniform hemisphere": (warps.square_to_uniform_hemisphere, one_minus_cos),
    **{
        f"cone {c:g}": (lambda u2, c=c: warps.square_to_cone(u2, c), lambda w, c=c: one_minus_cos(w) / c)
        for c in (5e-13, 1e-3, 0.5, 1.0, 2.0)
    },
    **{
        f"cosine power {n:g}": (
            lambda u2, n=n: warps.square_to_cosine_power(u2, n),
            lambda w, n=n: -np.expm1((n + 1) * np.log1p(-np.minimum(one_minus_cos(w), 1 - 2.0**-53))),
        )
        for n in EXPONENTS
    },
}


@pytest.mark.parametrize("name", DISTRIBUTIONS)
def test_the_distribution_at_a_warped_number_is_the_number(name):
    """B1. Needed because no histogram could tell exponent n from n + 1 for large n. Detects 1e-12."""
    check_inverse_distribution(*DISTRIBUTIONS[name])


@pytest.mark.parametrize(
    "mutant",
    [
        lambda u2: warps.square_to_cosine_power(u2, 1e6 + 1),
        lambda u2: warps.square_to_cosine_power(u2[::-1], 1e6),
        lambda u2: warps.square_to_cone(u2, 1 - (1 - u2[0]) ** (1 / (1e6 + 1))),
    ],
    ids=["another exponent", "swapped numbers", "cancelling power"],
)
def test_the_inverse_distribution_catches_a_broken_warp(mutant):
    with pytest.raises(AssertionError):
        check_inverse_distribution(mutant, DISTRIBUTIONS["cosine power 1e+06"][1])


def test_directions_are_unit():
    for name, (warp, _) in DISTRIBUTIONS.items():
        if name != "disk":
            assert np.abs(np.linalg.norm(warp(U2), axis=0) - 1).max() <= 1e-15 * 4, name


def integral(pdf):
    """Integral of pdf(w) over the sphere, Gauss-Legendre in z on each side of the horizon and about both poles."""
    x, weight = np.polynomial.legendre.leggauss(24)
    edges = np.unique(np.concatenate(([0.0, 2.0], 2.0 ** -np.arange(44.0), 1 - 2.0 ** -np.arange(1.0, 44))))
    half = np.diff(edges)[:, None] / 2
    q = (edges[:-1, None] + half + half * x).ravel()
    sin = np.sqrt(q * (2 - q))
    w = np.stack((sin, np.zeros_like(q), 1 - q))
    return 2 * np.pi * (pdf(w) * (half * weight).ravel()).sum()


@pytest.mark.parametrize("n", EXPONENTS)
def test_cosine_power_density_integrates_to_one(n):
    assert integral(lambda w: warps.square_to_cosine_power_pdf(w, n)) == pytest.approx(1, abs=1e-9)


def test_densities_integrate_to_one():
    """B3: on the hemisphere, the cone and the disk."""
    assert integral(warps.square_to_cosine_hemisphere_pdf) == pytest.approx(1, abs=1e-12)
    assert integral(warps.square_to_uniform_hemisphere_pdf) == pytest.approx(1, abs=1e-12)
    assert np.pi * warps.square_to_disk_pdf() == pytest.approx(1, abs=1e-15)
    for c in (5e-13, 0.5, 2.0):
        assert 2 * np.pi * c * warps.square_to_cone_pdf(c) == pytest.approx(1, rel=1e-12)


def stretch(warp, u2, step=1e-6):
    """Area on the warp's target per area of the square around u2 (2, N), by central differences."""
    columns = []
    for axis in (0, 1):
        shift = np.zeros((2, 1))
        shift[axis] = step
        columns.append((warp(u2 + shift) - warp(u2 - shift)) / (2 * step))
    if len(columns[0]) == 2:
        return np.abs(columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0])
    return np.linalg.norm(np.cross(*columns, axis=0), axis=0)


def check_density_is_one_over_the_stretch(warp, pdf):
    """B2, B4 without chance: pdf(warp(u)) |d warp / d u| = 1 at 10,000 places, away from seams and poles."""
    u2 = 0.01 + 0.98 * h.uniform(21, 10_000)
    # Triangles fold along the diagonal, and the polygon has one in each fifth.
    in_fifth = np.mod(5 * u2[0], 1)
    near_seam = (np.abs(u2[0] - u2[1]) < 1e-3) | (np.abs(in_fifth - 0.5) > 0.49) | (np.abs(in_fifth - u2[1]) < 1e-2)
    u2 = u2[:, ~near_seam]
    np.testing.assert_allclose(stretch(warp, u2) * pdf(warp(u2)), 1, rtol=1e-6)


DENSITIES = {
    "disk": (warps.square_to_disk, lambda w: warps.square_to_disk_pdf()),
    "cosine hemisphere": (warps.square_to_cosine_hemisphere, warps.square_to_cosine_hemisphere_pdf),
    "uniform hemisphere": (warps.square_to_uniform_hemisphere, warps.square_to_uniform_hemisphere_pdf),
    "triangle": (warps.square_to_triangle, lambda w: 2.0),
    "polygon": (lambda u2: warps.square_to_polygon(u2, 5, 0.3), lambda w: warps.square_to_polygon_pdf(5)),
    **{
        f"cone {c:g}": (lambda u2, c=c: warps.square_to_cone(u2, c), lambda w, c=c: warps.square_to_cone_pdf(c))
        for c in (5e-13, 1e-3, 0.5, 2.0)
    },
    **{
        f"cosine power {n:g}": (
            lambda u2, n=n: warps.square_to_cosine_power(u2, n),
            lambda w, n=n: warps.square_to_cosine_power_pdf(w, n),
        )
        for n in EXPONENTS
    },
}


@pytest.mark.parametrize("name", DENSITIES)
def test_a_density_is_one_over_the_stretch_of_its_warp(name):
    check_density_is_one_over_the_stretch(*DENSITIES[name])


@pytest.mark.parametrize(
    ("name", "warp"),
    [
        ("disk", lambda u2: np.stack((u2[0] * np.cos(2 * np.pi * u2[1]), u2[0] * np.sin(2 * np.pi * u2[1])))),
        ("cosine hemisphere", warps.square_to_uniform_hemisphere),
        ("cosine power 1e+06", lambda u2: warps.square_to_cosine_power(u2, 1e6 + 10)),
        ("triangle", lambda u2: np.stack((u2[0], u2[1] * (1 - u2[0])))),
    ],
    ids=["no root", "no cosine", "another exponent", "crowded corner"],
)
def test_the_stretch_catches_a_warp_of_another_density(name, warp):
    with pytest.raises(AssertionError):
        check_density_is_one_over_the_stretch(warp, DENSITIES[name][1])


@chance.fresh
def test_moments_of_the_warps():
    """B5, with 1e6 samples: detects 0.3 % of any of them."""
    u2 = h.uniform(11, N)
    x, y = warps.square_to_disk(u2)
    assert h.mean_is(x * x + y * y, 1 / 2)
    assert h.mean_is(np.hypot(x, y), 2 / 3)
    assert h.mean_is(x, 0)
    assert h.mean_is(x * y, 0)
    assert h.mean_is(warps.square_to_cosine_hemisphere(u2)[2], 2 / 3)
    assert h.mean_is(warps.square_to_uniform_hemisphere(u2)[2], 1 / 2)
    for n in EXPONENTS:
        q = one_minus_cos(warps.square_to_cosine_power(u2, n))
        assert h.mean_is(q, 1 / (n + 2)), n  # E[cos] = (n + 1) / (n + 2)


def test_moments_catch_a_disk_without_its_root():
    r = h.uniform(11, N)[0]
    assert not h.mean_is(r * r, 1 / 2)


def check_triangle(warp):
    u, v = warp(h.uniform(12, 200_000))
    assert (u >= 0).all()
    assert (v >= 0).all()
    assert (u + v <= 1).all()
    # Uniform where (1 - u)^2 and v / (1 - u) are uniform and independent.
    counts = np.histogram2d((1 - u) ** 2, v / (1 - u), bins=32, range=((0, 1), (0, 1)))[0]
    assert h.chi2_p(counts, np.full(1024, u.size / 1024)) > h.ALPHA


@chance.fresh
def test_points_on_a_triangle_are_uniform():
    """chi2 in 32 x 32 bins: detects 7 % of the density in half of the bins."""
    check_triangle(warps.square_to_triangle)


def test_uniformity_catches_a_triangle_folded_wrongly():
    def crowded(u2):
        return np.stack((u2[0], u2[1] * (1 - u2[0])))

    with pytest.raises(AssertionError):
        check_triangle(crowded)


def polygon(corners, rotation):
    """Corners (2, n) by definition: on the unit circle, the middle of an edge at the angle `rotation`."""
    angle = rotation + (2 * np.arange(corners) + 1) * np.pi / corners
    return np.stack((np.cos(angle), np.sin(angle)))


def check_polygon(warp, corners, rotation):
    """As many points in each small square as belongs to its share of the polygon; the share by counting a fine grid."""
    x, y = warp(h.uniform(13, 200_000), corners, rotation)
    edges = np.linspace(-1, 1, 17)
    fine = (np.arange(2048) + 0.5) / 1024 - 1
    points = np.stack(np.meshgrid(fine, fine, indexing="ij")).reshape(2, -1)
    place = polygon(corners, rotation)
    to = np.roll(place, -1, axis=1) - place
    away = points[:, None] - place[:, :, None]
    inside = points[:, ((to[0][:, None] * away[1] - to[1][:, None] * away[0]) >= 0).all(axis=0)]
    share = np.histogram2d(*inside, bins=(edges, edges))[0] / inside.shape[1]
    assert h.chi2_p(np.histogram2d(x, y, bins=(edges, edges))[0], share * x.size) > h.ALPHA
    assert inside.shape[1] * (2 / 2048) ** 2 * warps.square_to_polygon_pdf(corners) == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize(("corners", "rotation"), [(3, 0.0), (3, 0.4), (4, np.pi / 4), (5, -1.0), (7, 6.0), (16, 0.1)])
@chance.fresh
def test_points_on_a_polygon_are_uniform(corners, rotation):
    """chi2 in 16 x 16 bins: detects 7 % of the density in half of the bins, and any point outside."""
    check_polygon(warps.square_to_polygon, corners, rotation)


def test_uniformity_catches_a_polygon_turned_by_two_degrees_and_a_crowded_one():
    def turned(u2, corners, rotation):
        return warps.square_to_polygon(u2, corners, rotation + np.radians(2))

    def crowded(u2, corners, rotation):
        return warps.square_to_polygon(np.stack((u2[0], u2[1] ** 1.1)), corners, rotation)

    for mutant in (turned, crowded):
        with pytest.raises(AssertionError):
            check_polygon(mutant, 5, 0.3)


def test_warps_keep_float32_and_stay_in_range_at_the_ends():
    u = np.array([0, 2.0**-24, 1 - 2.0**-24], np.float32)
    u2 = np.stack(np.meshgrid(u, u)).reshape(2, -1)
    exponent = np.full(9, 1e6, np.float32)
    for w in (
        warps.square_to_disk(u2),
        warps.square_to_cosine_hemisphere(u2),
        warps.square_to_uniform_hemisphere(u2),
        warps.square_to_cone(u2, np.full(9, 5e-13, np.float32)),
        warps.square_to_cosine_power(u2, exponent),
        warps.square_to_triangle(u2),
        warps.square_to_polygon(u2, np.full(1, 6, np.float32), np.full(1, 0.5, np.float32)),
    ):
        assert w.dtype == np.float32
        assert np.isfinite(w).all()
    assert warps.square_to_cosine_hemisphere(u2)[2].min() >= 0


@pytest.mark.parametrize("sine", [1e-8, 1e-6, 1e-3, 0.5, 0.999])
def test_the_solid_angle_of_a_distant_ball_has_all_its_digits(sine):
    """B11: 1 / pdf = 2 pi (1 - cos), relative 1e-12; at 1e-6 rad 2 pi 5e-13, where the naive form is 8.7e-5 off."""
    ball = PointLight(position=(0.0, 0.0, 1.0), radius=sine, soft_falloff=False)
    pdf = ball.sample(h.table(ball.row(h.UNIT_FRAME)), np.zeros((3, 1)), np.full((2, 1), 0.5))[3]
    # 1 - sqrt(1 - s^2) by Newton's method in rational numbers.
    s2 = Fraction(sine) ** 2
    root = Fraction(float(np.sqrt(1 - sine**2)))
    for _ in range(3):
        root = ((root + (1 - s2) / root) / 2).limit_denominator(10**40)
    truth = float(1 - root) * 2 * np.pi
    assert 1 / pdf[0] == pytest.approx(truth, rel=1e-12)
    naive = 2 * np.pi * (1 - np.cos(np.arcsin(1e-6)))
    assert abs(naive / (2 * np.pi * 5.00000000000125e-13) - 1) > 1e-5


def test_the_level_of_these_tests_is_what_they_say():
    assert pytest.approx(4.892, abs=1e-3) == h.Z
    assert stats.chi2.isf(h.ALPHA, 1023) == pytest.approx(1252.6, abs=0.1)
