"""What GGX reflects on the whole, by closed forms, and lobes as wide as its own, by counting."""

import numpy as np
import pytest

from glanz.engine.maths import ggx
from glanz.engine.maths.fresnel import fresnel_dielectric
from glanz.tests import helpers as h

COSINES = np.linspace(0.05, 1, 39, dtype=np.float32)


def test_seen_from_above_the_roughest_surface_reflects_one_minus_ln_2():
    """alpha = 1: cos(h)^2 is uniform, z = 2 cos(h)^2 - 1 and G2 / G1 = 2 z / (1 + z); the integral over z is 1 - ln 2."""
    assert ggx.moment("A", np.ones(1, np.float32), 1.0)[0] == pytest.approx(1 - np.log(2), rel=2e-3)


@pytest.mark.parametrize("eta", [1.2, 1.5, 2.0, 4.0])
def test_a_smooth_surface_reflects_what_fresnel_says(eta):
    for name in "FV":
        found = ggx.fresnel_moment(name, COSINES, np.float32(0), np.float32(eta))
        assert found == pytest.approx(fresnel_dielectric(COSINES, eta), abs=0.01)
    assert ggx.moment("P", COSINES, np.float32(0)) == pytest.approx((1 - COSINES) ** 5, abs=0.005)


def test_from_within_a_smooth_body_all_is_reflected_beyond_the_critical_angle():
    critical = np.sqrt(1 - 1 / 1.5**2)
    cos = np.array([0.1, critical - 0.1], np.float32)
    assert ggx.fresnel_moment("V", cos, np.float32(0), np.float32(1 / 1.5)) == pytest.approx(1, abs=0.02)


def test_nothing_reflects_more_than_arrives():
    r = np.linspace(0, 1, 21, dtype=np.float32)[:, None]
    a = ggx.moment("A", COSINES, r)
    assert (a <= 1 + 1e-6).all() and (a > 0).all()
    for eta in (1 / 3, 0.9, 1.0, 1.1, 3.0):
        assert (ggx.fresnel_moment("F", COSINES, r, np.float32(eta)) <= a + 1e-6).all()


def reflected_angles(alpha, n=400_001):
    """Angles between reflected directions above the horizon and the mirror's, seen from above."""
    u = (np.arange(n) + 0.5) / n
    h = np.arctan(alpha * np.sqrt(u / (1 - u)))
    return 2 * h[2 * h < np.pi / 2]


@pytest.mark.parametrize("roughness", [0.1, 0.25, 0.5, 0.75, 1.0])
def test_half_of_the_light_is_in_the_same_cone_as_of_ggx(roughness):
    exponent = ggx.exponent_of_reflection(np.float32(roughness))
    median = np.median(reflected_angles(roughness**2))
    assert np.cos(median) ** (exponent + 1) == pytest.approx(0.5, abs=1e-3)


def test_an_exponent_of_normals_instead_of_directions_is_no_match():
    median = np.median(reflected_angles(0.25))
    assert abs(np.cos(median) ** (2 / 0.25**2 - 1) - 0.5) > 0.1


@pytest.mark.parametrize("roughness", [0.25, 0.5, 0.75])
@pytest.mark.parametrize("eta", [1.33, 1.5, 1 / 1.33])
def test_half_of_the_light_that_passes_is_in_the_same_cone_as_of_ggx(roughness, eta):
    h = np.arctan(roughness**2)
    turn = abs(h - np.arcsin(min(np.sin(h) / eta, 1)))
    exponent = float(ggx.exponent_of_refraction(np.float32(roughness), eta))
    assert np.cos(turn) ** (exponent + 1) == pytest.approx(0.5, abs=2e-3)


def test_the_smoothest_and_the_roughest_have_the_sharpest_and_the_widest_lobe():
    assert ggx.exponent_of_reflection(np.float32(0)) == 1e6
    assert ggx.exponent_of_reflection(np.float32(1)) == pytest.approx(0, abs=1e-6)
    assert ggx.exponent_of_refraction(np.float32(0.5), 1.0) == 1e6


def sent_on(alpha, cos, eta, side=700):
    """What a rough boundary sends on of light at this angle, both ways: Walter et al. 2007, eq. 20 and 21, added up over all directions."""
    u = v = (np.arange(side) + 0.5) / side
    # Finer towards the horizon and the normal, where cosines are cubic in the numbers.
    z, weight = np.sin(0.5 * np.pi * u) ** 2, 0.5 * np.pi * np.sin(np.pi * u) / side
    z, phi = np.meshgrid(z, 2 * np.pi * v, indexing="ij")
    i = np.array((np.sqrt(1 - cos * cos), 0.0, cos))

    def smith(c):
        return 0.5 * (np.sqrt(1 + alpha**2 * (1 - c * c) / (c * c)) - 1)

    total = 0.0
    for sign in (1, -1):
        o = np.stack((np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), sign * z))
        h = i[:, None, None] + (o if sign > 0 else eta * o)
        size = np.sqrt((h * h).sum(axis=0))
        h = h / size * np.where(h[2] < 0, -1, 1)
        hi, ho = np.tensordot(i, h, 1), (o * h).sum(axis=0)
        d = alpha**2 / (np.pi * ((alpha**2 - 1) * h[2] ** 2 + 1) ** 2)
        share = fresnel_dielectric(np.clip(hi, 1e-9, 1), eta)
        both = d / (1 + smith(cos) + smith(z)) / cos
        refracted = np.where(ho < 0, (1 - share) * both * np.abs(hi * ho) * eta**2 / size**2, 0)
        f = share * both / 4 if sign > 0 else refracted
        total += (np.where(hi > 0, f, 0) * weight[:, None]).sum() * 2 * np.pi / side
    return total


@pytest.mark.parametrize("eta", [1.5, 2.5, 1 / 1.5])
@pytest.mark.parametrize(("roughness", "cos"), [(0.5, 0.9), (0.75, 0.5), (1.0, 0.25), (1.0, 0.9)])
def test_what_a_rough_boundary_sends_on_is_the_integral_over_all_directions(roughness, cos, eta):
    found, _ = ggx.boundary(np.array([cos], np.float32), np.float32(roughness), np.float32(eta))
    assert found[0] == pytest.approx(sent_on(roughness**2, cos, eta), abs=0.01)


def test_a_smooth_boundary_sends_on_all():
    for eta in (1.5, 1 / 1.5):
        once, mean = ggx.boundary(COSINES, np.float32(0), np.float32(eta))
        assert once == pytest.approx(1, abs=1e-3)
        assert mean == pytest.approx(1, abs=1e-3)


def test_only_what_is_asked_for_of_the_tables_is_worked_out():
    """A scene of one index of refraction needs the entries on both sides of it; who else is there changes nothing."""
    rows = ggx._fresnel_row, ggx._boundary_row
    for row in rows:
        row.cache_clear()
    cos, roughness, eta = np.float32([0.3, 0.8]), np.float32([0.2, 0.7]), np.float32([1.5])
    alone = [ggx.fresnel_moment("F", cos, roughness, eta), *ggx.boundary(cos, roughness, eta)]
    assert [row.cache_info().currsize for row in rows] == [2, 2]
    others = [*(np.tile(a, 2) for a in (cos, roughness)), np.float32([1.5, 1.5, 0.5, 3.0])]
    together = [ggx.fresnel_moment("F", *others), *ggx.boundary(*others)]
    assert all(h.same_bits(a, b[:2]) for a, b in zip(alone, together))
    assert ggx.fresnel_moment("F", *np.zeros((3, 0), np.float32)).shape == (0,)
