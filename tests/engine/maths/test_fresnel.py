"""Smooth boundaries against closed forms (catalogue D1 to D8)."""

import numpy as np
import pytest
from scipy import integrate

from glanz.engine.maths.fresnel import fresnel_conductor, fresnel_dielectric, refract, refracted_cosine
from glanz.tests import helpers as h

Z = np.array([[0.0], [0.0], [1.0]])
EXACT, BENT = fresnel_dielectric, refract
"""What the mutants below are made of."""


def share(degrees, eta):
    return float(fresnel_dielectric(np.cos(np.radians([degrees])), np.array([eta]))[0])


@pytest.mark.parametrize(("degrees", "refracted"), [(30, 19.471220634490690), (45, 28.125505702055030), (60, 35.264389682754654)])
def test_snell(degrees, refracted):
    """D1: sin t = sin i / n, to 1e-9 degrees; the refracted vector is unit to 1e-15."""
    wi = refract(h.at_angle(np.radians(degrees)), Z, np.array([1.5]))
    assert np.degrees(np.arccos(-wi[2, 0])) == pytest.approx(refracted, abs=1e-9)
    assert np.linalg.norm(wi) == pytest.approx(1, abs=1e-15)
    # On the other side of the normal, and in the same plane.
    assert wi[0, 0] == pytest.approx(-np.sin(np.radians(refracted)), abs=1e-12)


@pytest.mark.parametrize(
    ("degrees", "eta", "expected"),
    [(0, 1.5, 0.04), (45, 1.5, 0.050239911), (0, 2.42, 0.172394925), (0, 1e3, 0.996007988), (0, 1 / 1.5, 0.04)],
)
def test_fresnel(degrees, eta, expected):
    """D2."""
    assert share(degrees, eta) == pytest.approx(expected, abs=1e-9)


COPPER = np.array([[0.2004], [0.9240], [1.1022]]), np.array([[3.9129], [2.4528], [2.1422]])
"""eta and k, as tables have them for red, green and blue."""


def complex_share(cos, index):
    """What is reflected at a boundary of a complex index, by the amplitudes of both polarisations."""
    cos_t = np.sqrt(1 - (1 - cos * cos) / index**2)
    across = (cos - index * cos_t) / (cos + index * cos_t)
    parallel = (index * cos - cos_t) / (index * cos + cos_t)
    return 0.5 * (abs(across) ** 2 + abs(parallel) ** 2)


def check_conductors(f):
    cos = np.linspace(1e-3, 1, 50)
    for eta, k in (COPPER, (np.full((3, 1), 0.05), np.full((3, 1), 4.0)), (np.full((3, 1), 1.5), np.zeros((3, 1)))):
        np.testing.assert_allclose(f(cos, eta, k), complex_share(cos, eta + 1j * k), rtol=1e-11)


def test_metals_reflect_as_their_complex_index_says():
    """Also without extinction, where they are glass."""
    check_conductors(fresnel_conductor)
    np.testing.assert_allclose(
        fresnel_conductor(np.ones(1), *COPPER), ((COPPER[0] - 1) ** 2 + COPPER[1] ** 2) / ((COPPER[0] + 1) ** 2 + COPPER[1] ** 2)
    )


def test_a_metal_whose_extinction_has_the_wrong_sign_of_its_square_is_caught():
    with pytest.raises(AssertionError):
        check_conductors(lambda cos, eta, k: fresnel_conductor(cos, np.sqrt(eta * eta + k * k), 0 * k))


def test_brewster():
    """D3: at atan n only light across the plane is reflected, ((n^2 - 1) / (n^2 + 1))^2."""
    assert 2 * share(np.degrees(np.arctan(1.5)), 1.5) == pytest.approx((1.25 / 3.25) ** 2, rel=1e-12)


@pytest.mark.parametrize(("below", "expected"), [(1e-3, 0.763641188), (1e-5, 0.972936840), (1e-7, 0.997255167)])
def test_the_critical_angle_is_approached_without_loss_of_digits(below, expected):
    """D4, to 1e-6: the angle itself is known to 1e-16 rad only. Above it the share is exactly 1."""
    critical = np.arcsin(1 / 1.5)
    assert share(np.degrees(critical - below), 1 / 1.5) == pytest.approx(expected, abs=1e-6)
    assert share(np.degrees(critical + below), 1 / 1.5) == 1


def test_grazing():
    """D5: 1 - R tends to 2 c (n^2 + 1) / sqrt(n^2 - 1)."""
    c = 1e-7
    passed = 1 - float(fresnel_dielectric(np.array([c]), np.array([1.5]))[0])
    assert passed == pytest.approx(5.81377e-7, rel=1e-5)


@pytest.mark.parametrize("eta", [1.0, 1 + 1e-12])
def test_equal_media_have_no_boundary(eta):
    """D6: nothing is reflected, nothing bent."""
    for degrees in (0, 30, 89):
        assert share(degrees, eta) <= 1e-9
        wo = h.at_angle(np.radians(degrees), 0.4)
        assert np.abs(refract(wo, Z, np.array([eta])) + wo).max() <= 1e-9


def test_both_sides_reflect_alike():
    """D7: R(outside, i) = R(inside, t); closer to grazing cos t itself loses the digits."""
    cos_i = np.linspace(0.05, 1, 1_000)
    eta = np.full(1_000, 1.5)
    inside = fresnel_dielectric(refracted_cosine(cos_i, eta), 1 / eta)
    assert np.abs(fresnel_dielectric(cos_i, eta) - inside).max() <= 1e-12


def test_hemispherical_averages():
    """D8: external .09177796, internal .59634576 = 1 - (1 - external) / n^2."""

    def average(eta, split):
        f = lambda c: 2 * c * float(fresnel_dielectric(np.array([c]), np.array([eta]))[0])  # noqa: E731
        return integrate.quad(f, 0, split, limit=200)[0] + integrate.quad(f, split, 1, limit=200)[0]

    assert average(1.5, 0.5) == pytest.approx(0.09177796, abs=1e-7)
    assert average(1 / 1.5, np.sqrt(1 - 1 / 2.25)) == pytest.approx(0.59634576, abs=1e-7)


def test_the_laws_catch_an_index_upside_down():
    with pytest.raises(AssertionError):
        assert share(45, 1 / 1.5) == pytest.approx(0.050239911, abs=1e-9)


def schlick(cos_i, eta):
    """Schlick's approximation, which many renderers use."""
    r0 = ((eta - 1) / (eta + 1)) ** 2
    return r0 + (1 - r0) * (1 - cos_i) ** 5


def across_only(cos_i, eta):
    """Light of one polarisation."""
    cos_t = refracted_cosine(cos_i, eta)
    return ((cos_i - eta * cos_t) / (cos_i + eta * cos_t)) ** 2


def single(cos_i, eta):
    """In float32, where 1 - R has no digits left along the surface."""
    return EXACT(cos_i.astype(np.float32), eta.astype(np.float32))


@pytest.mark.parametrize(
    ("mutant", "law", "values"),
    [
        (schlick, "test_fresnel", (45, 1.5, 0.050239911)),
        (across_only, "test_fresnel", (45, 1.5, 0.050239911)),
        (schlick, "test_brewster", ()),
        (schlick, "test_the_critical_angle_is_approached_without_loss_of_digits", (1e-3, 0.763641188)),
        (single, "test_the_critical_angle_is_approached_without_loss_of_digits", (1e-7, 0.997255167)),
        (schlick, "test_grazing", ()),
        (single, "test_grazing", ()),
        (lambda cos_i, eta: np.maximum(EXACT(cos_i, eta), 1e-6), "test_equal_media_have_no_boundary", (1.0,)),
        (schlick, "test_both_sides_reflect_alike", ()),
        (schlick, "test_hemispherical_averages", ()),
    ],
)
def test_the_laws_catch_other_shares(monkeypatch, mutant, law, values):
    """D2 to D8: each notices a formula that is only nearly Fresnel's."""
    check = globals()[law]
    check(*values)
    monkeypatch.setitem(globals(), "fresnel_dielectric", mutant)
    with pytest.raises(AssertionError):
        check(*values)


def test_snell_catches_a_direction_that_is_not_bent_enough(monkeypatch):
    """D1: an index that is off by a millionth; and a vector that is not unit."""
    for mutant in (lambda wo, n, eta: BENT(wo, n, eta * (1 + 1e-6)), lambda wo, n, eta: BENT(wo, n, eta) * (1 + 1e-14)):
        monkeypatch.setitem(globals(), "refract", mutant)
        with pytest.raises(AssertionError):
            test_snell(45, 28.125505702055030)
        monkeypatch.undo()
