"""The Blinn-Phong lobe against closed forms."""

import numpy as np
import pytest

from glanz.engine import BlinnPhong
from glanz.engine.bsdfs import blinn_phong
from glanz.tests import helpers as h

Z = h.unit(0, 0, 1)
EXPONENTS = (0.0, 0.5, 1.0, 10.0, 1e3, 1e6)


def albedo(angle, n):
    """Integral of f cos over the hemisphere, f from `BlinnPhong.eval`: over half vectors, by Gauss-Legendre in cos^(n + 1).

    The half vectors of light above the horizon have h . z > cos(45 degrees) at normal incidence; there the edge is exact.
    """
    k, wo = h.table(BlinnPhong((1.0, 1.0, 1.0), n).row()), h.at_angle(angle)
    x, weight = np.polynomial.legendre.leggauss(200)
    least = 2 ** (-(n + 1) / 2) if angle == 0 else 0.0
    u = least + (1 - least) * 0.5 * (x + 1)
    phi = (np.arange(1_000) + 0.5) / 1_000 * np.pi
    # 1 - cos keeps its digits for n = 1e6.
    q = -np.expm1(np.log(u) / (n + 1))[:, None]
    sin = np.sqrt(q * (2 - q))
    half = np.stack(np.broadcast_arrays(sin * np.cos(phi), sin * np.sin(phi), 1 - q))
    cos = np.einsum("i,ijk->jk", wo[:, 0], half)
    wi = 2 * cos * half - wo[:, :, None]
    f = BlinnPhong.eval(k, Z, wo, wi.reshape(3, -1))[0].reshape(cos.shape)
    counts = np.where((wi[2] > 0) & (cos > 0), f * wi[2] * 4 * cos, 0).mean(axis=1)
    return (counts * weight * (1 - least) / 2 * 2 * np.pi / (n + 1) / (1 - q[:, 0]) ** n).sum()


@pytest.mark.parametrize("n", EXPONENTS)
def test_all_is_reflected_at_normal_incidence(n):
    """The factor (n + 2)(n + 4) / (8 pi (2^(-n/2) + n)) makes it 1 exactly: to 1e-9, sharp lobes to 1e-6."""
    assert albedo(0.0, n) == pytest.approx(1, abs=1e-6 if n > 10 else 1e-9)


@pytest.mark.parametrize("n", EXPONENTS)
def test_nowhere_is_more_reflected_than_at_normal_incidence(n):
    """The bound, at 16 angles up to grazing; and less and less. Detects 1 in 10,000."""
    shares = [albedo(angle, n) for angle in np.linspace(0, np.pi / 2, 16)]
    assert max(shares) <= 1 + 1e-4
    assert (np.diff(shares) <= 1e-4).all()


def test_exponent_zero_is_lambert():
    k = h.table(BlinnPhong((0.8, 0.5, 0.1), 0.0).row())
    f = BlinnPhong.eval(k, Z, h.at_angle(0.4), h.at_angle(1.2, 2.0))
    assert f.ravel() == pytest.approx(np.array((0.8, 0.5, 0.1)) / np.pi, rel=1e-14)


@pytest.mark.parametrize("degrees", [30, 60])
def test_the_limit_is_the_mirror_times_the_squared_cosine(degrees):
    """For n = 1e6, to 0.1 %."""
    assert albedo(np.radians(degrees), 1e6) == pytest.approx(np.cos(np.radians(degrees)) ** 2, rel=1e-3)


def test_the_bound_is_exact_where_the_usual_factor_is_an_approximation():
    """(n + 8) / (8 pi), the usual one: 7 % too bright at n = 10, as good as exact for n = 0 and 1e6."""
    for n, excess in ((0.0, 1.0), (10.0, 1.0748), (1e6, 1.0)):
        ours = blinn_phong.factor(n)
        assert (n + 8) / (8 * np.pi) / ours == pytest.approx(excess, abs=1e-4)


def test_the_bound_catches_the_factor_of_phong(monkeypatch):
    """(n + 2) / (2 pi) belongs to the lobe about the mirror direction: four times too much for large n."""
    assert albedo(0.0, 1e3) <= 1 + 1e-6
    monkeypatch.setattr(blinn_phong, "factor", lambda n: (n + 2) / (2 * np.pi))
    assert albedo(0.0, 1e3) > 3.9


@pytest.mark.parametrize("n", [0.0, 0.5, 1.0, 10.0, 100.0])
@pytest.mark.parametrize("angle", [0.0, 0.5, 1.2])
def test_the_density_integrates_to_one_over_directions(n, angle):
    """Over all directions in polar coordinates about wo, which know nothing of half vectors and their Jacobian.

    The pole 1 / (wo . h) at -wo is none in these.
    """
    k, wo = h.table(BlinnPhong((1.0,) * 3, n).row()), h.at_angle(angle)
    frame = h.frame_towards(wo[:, 0])
    x, weight = np.polynomial.legendre.leggauss(400)
    theta = np.pi * 0.5 * (x + 1)
    phi = (np.arange(800) + 0.5) / 800 * 2 * np.pi
    sin, cos = np.sin(theta)[:, None], np.cos(theta)[:, None]
    local = np.stack(np.broadcast_arrays(sin * np.cos(phi), sin * np.sin(phi), cos))
    pdf = BlinnPhong.pdf(k, Z, wo, frame @ local.reshape(3, -1)).reshape(400, 800)
    integral = (pdf.mean(axis=1) * sin[:, 0] * weight).sum() * np.pi / 2 * 2 * np.pi
    # |n . h|^n has a kink where the half vector crosses the horizon, of odd order below n = 1.
    assert integral == pytest.approx(1, abs=1e-3 if n in (0.5, 1.0) else 1e-5)


@pytest.mark.parametrize("n", EXPONENTS)
def test_the_weight_of_a_sample_is_bounded(n):
    """f cos / pdf = c(n) 8 pi / (n + 1) (wo . h) cos(theta), at most 8: no fireflies. Its mean is the albedo."""
    value, size = BlinnPhong((1.0,) * 3, n), 200_000
    k = h.table(value.row())
    for angle in (0.0, np.radians(45), np.radians(80)):
        wo = h.at_angle(angle)
        wi = value.sample(k, np.repeat(Z, size, 1), wo, h.uniform(3, size))
        weight = value.eval(k, Z, wo, wi)[0] * np.maximum(wi[2], 0) / value.pdf(k, Z, wo, wi)
        half_cos = np.linalg.norm(wo + wi, axis=0) / 2
        np.testing.assert_allclose(weight, blinn_phong.factor(n) * 8 * np.pi / (n + 1) * half_cos * np.maximum(wi[2], 0), rtol=1e-9)
        assert weight.max() <= 8
        assert h.mean_is(weight, albedo(angle, n), floor=1e-4), angle


def test_seen_straight_it_is_as_wide_as_phong_of_a_quarter_of_the_exponent():
    """cos^n(theta / 2) and cos^(n / 4)(theta), to 1 % where the lobe is."""
    k = h.table(BlinnPhong((1.0,) * 3, 4_000.0).row())
    for theta in (0.01, 0.03, 0.05):
        lobe = BlinnPhong.eval(k, Z, h.at_angle(0.0), h.at_angle(theta))[0, 0] / blinn_phong.factor(4_000.0)
        assert lobe == pytest.approx(np.cos(theta) ** 1_000, rel=1e-2)


def test_in_the_illumination_model_it_is_a_power_of_the_cosine_to_the_half_vector():
    """k_s (n . h)^n (Blinn 1977), without any factor."""
    k, wo, wi = h.table(BlinnPhong((0.5, 0.3, 0.1), 7.0).row()), h.at_angle(0.3), h.at_angle(0.8, 2.0)
    half = (wo + wi) / np.linalg.norm(wo + wi)
    assert BlinnPhong.illuminate(k, Z, wo, wi)[:, 0] == pytest.approx(np.array((0.5, 0.3, 0.1)) * half[2, 0] ** 7, rel=1e-12)
