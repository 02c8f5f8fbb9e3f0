"""Smooth boundaries of any index, straight on and along the surface, against sixty digits (catalogue D1 to D5, D7, D8)."""

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest
from scipy import integrate

from glanz.engine.maths import fresnel
from glanz.engine.maths.fresnel import fresnel_dielectric, refract, refracted_cosine
from glanz.tests import helpers as h

IORS = (1.0, 1 + 1e-12, 1 / 1.5, 1.5, 2.42, 1e3)
GRAZING = (1e-3, 1e-5, 1e-7)
COSINES = (1.0, 0.7, 0.3, *GRAZING)
Z = np.array([[0.0], [0.0], [1.0]])


def share(cos_i, eta):
    return float(fresnel_dielectric(np.array([cos_i]), np.array([eta]))[0])


def truth(cos_i, eta):
    """(what is reflected, what passes, cosine of the refracted direction) for these very float64 numbers."""
    with localcontext() as context:
        context.prec = 60
        c, n = Decimal(float(cos_i)), Decimal(float(eta))
        sine2 = (1 - c * c) / (n * n)
        if sine2 >= 1:
            return 1.0, 0.0, 0.0
        t = (1 - sine2).sqrt()
        across, parallel = (c - n * t) / (c + n * t), (n * c - t) / (n * c + t)
        reflected = (across**2 + parallel**2) / 2
        return float(reflected), float(1 - reflected), float(t)


@pytest.mark.parametrize("eta", IORS)
def test_both_shares_have_the_digits_of_float64(eta):
    """D2, D5, D7: to 2^-51, and what passes along the surface as well: to 1e-9 of it at 1e-7 rad, where D5 asks for 1e-6."""
    for cos_i in COSINES:
        reflected, passed, _ = truth(cos_i, eta)
        assert abs(share(cos_i, eta) - reflected) <= 2.0**-51, cos_i
        assert abs(1 - share(cos_i, eta) - passed) <= 2.0**-51, cos_i


@pytest.mark.parametrize("eta", IORS)
def test_refracted_directions_obey_snell_at_any_angle(eta):
    """D1: the sine by the index, to 1e-15 of it; the cosine to what one unit in that of incidence is worth; unit to 1e-15."""
    for angle in (0.0, 0.5, 1.2, *(math.pi / 2 - g for g in GRAZING)):
        wo = h.at_angle(angle, 0.4)
        _, passed, cos_t = truth(wo[2, 0], eta)
        if passed == 0:
            assert share(wo[2, 0], eta) == 1
            continue
        wi = refract(wo, Z, np.array([eta]))
        assert np.linalg.norm(wi) == pytest.approx(1, abs=1e-15)
        np.testing.assert_allclose(wi[:2], -wo[:2] / eta, rtol=1e-15, atol=1e-16)
        assert -wi[2, 0] == pytest.approx(cos_t, abs=2.0**-52)


@pytest.mark.parametrize("eta", [eta for eta in IORS if abs(eta - 1) > 1e-3])
def test_brewster_for_every_index(eta):
    """D3: at atan n only light across the plane is reflected, ((n^2 - 1) / (n^2 + 1))^2."""
    assert 2 * share(1 / math.hypot(1, eta), eta) == pytest.approx(((eta**2 - 1) / (eta**2 + 1)) ** 2, rel=1e-12)


@pytest.mark.parametrize(("below", "expected"), [(1e-3, 0.763641188), (1e-5, 0.972936840), (1e-7, 0.997255167)])
def test_the_critical_angle_is_approached_to_nine_digits(below, expected):
    """D4, to the digits of the catalogue. From above it is 1 exactly."""
    critical = math.asin(1 / 1.5)
    assert share(math.cos(critical - below), 1 / 1.5) == pytest.approx(expected, abs=1e-9)
    assert share(math.cos(critical + below), 1 / 1.5) == 1


@pytest.mark.parametrize("eta", [1.5, 2.42, 1e3])
@pytest.mark.parametrize("cos_i", GRAZING)
def test_what_passes_along_the_surface_grows_with_the_cosine(eta, cos_i):
    """D5: 2 c (n^2 + 1) / sqrt(n^2 - 1) is the first term; the next one is as much smaller as that share itself."""
    first = 2 * cos_i * (eta**2 + 1) / math.sqrt(eta**2 - 1)
    assert 1 - share(cos_i, eta) == pytest.approx(first, rel=2 * first + 1e-8)


@pytest.mark.parametrize("eta", [1 + 1e-12, 1.5, 2.42, 1e3])
def test_both_sides_reflect_alike_up_to_the_surface(eta):
    """D7: R(outside, i) = R(inside, t), to what the rounding of cos t to 1e-16 is worth: n^2 / cos i of it in cos i, n times that in R.

    So 1e-12 is met down to a cosine of 0.004 for n = 1.5, and 1e-8 at 1e-7 rad; for n = 1e3 along the surface it says nothing.
    """
    for cos_i in COSINES:
        cos_t = refracted_cosine(np.array([cos_i]), np.array([eta]))
        inside = fresnel_dielectric(cos_t, np.array([1 / eta]))[0]
        assert abs(share(cos_i, eta) - inside) <= 1e-15 * eta**3 / cos_i, cos_i


def average(eta, split):
    """The share of even light that is reflected: 2 int R(c) c dc."""
    f = lambda c: 2 * c * share(c, eta)  # noqa: E731
    return sum(integrate.quad(f, low, high, limit=400, epsabs=1e-12, epsrel=1e-11)[0] for low, high in ((0, split), (split, 1)))


@pytest.mark.parametrize("eta", [1.5, 2.42, 10.0])
def test_even_light_is_reflected_from_within_by_the_etendue_of_without(eta):
    """D8 for any index: internal = 1 - (1 - external) / n^2, to 1e-9."""
    external, internal = average(eta, 1 / eta), average(1 / eta, math.sqrt(1 - 1 / eta**2))
    assert internal == pytest.approx(1 - (1 - external) / eta**2, abs=1e-9)
    if eta == 1.5:
        assert external == pytest.approx(0.09177796, abs=1e-8)
        assert internal == pytest.approx(0.59634576, abs=1e-8)


def by_the_sine(cos_i, eta):
    """Snell as it is usually written: 1 - sin^2 / eta^2 loses the digits of what passes near the critical angle."""
    return np.sqrt(np.maximum(1 - (1 - cos_i * cos_i) / (eta * eta), 0))


@pytest.mark.parametrize(
    ("law", "values"),
    [
        (test_both_sides_reflect_alike_up_to_the_surface, (1 + 1e-12,)),
        (test_refracted_directions_obey_snell_at_any_angle, (1 + 1e-12,)),
        (test_both_shares_have_the_digits_of_float64, (1 + 1e-12,)),
    ],
)
def test_digits_catch_a_cosine_that_cancels(law, values, monkeypatch):
    law(*values)
    monkeypatch.setattr(fresnel, "refracted_cosine", by_the_sine)
    with pytest.raises(AssertionError):
        law(*values)


@pytest.mark.parametrize("law", [test_brewster_for_every_index, test_even_light_is_reflected_from_within_by_the_etendue_of_without])
def test_the_laws_of_all_indices_catch_schlick(law, monkeypatch):
    def schlick(cos_i, eta):
        r0 = ((eta - 1) / (eta + 1)) ** 2
        return r0 + (1 - r0) * (1 - cos_i) ** 5

    monkeypatch.setitem(globals(), "fresnel_dielectric", schlick)
    with pytest.raises(AssertionError):
        law(2.42)
