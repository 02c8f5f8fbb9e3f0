"""Phong's lobe over the cosine of incidence, as the lecture has it, against closed forms."""

import numpy as np
import pytest

from glanz.engine import Phong, PhongLecture, SceneError
from glanz.engine.interfaces import albedo_of
from glanz.engine.maths.vectors import dot
from glanz.engine.scene.validate import validate
from glanz.engine.scene.values import Material
from glanz.tests import helpers as h

Z = h.unit(0, 0, 1)
N = 200_000
EXPONENTS = (0.0, 0.5, 1.0, 10.0, 1e3, 1e6)


def weights(value, angle, seed=3):
    """f cos / pdf, first channel, and wi (3, N) of samples seen from `angle`; 0 below the horizon."""
    k, wo = h.table(value.row()), h.at_angle(angle)
    wi = value.sample(k, np.repeat(Z, N, 1), wo, h.uniform(seed, N))
    f, pdf = value.eval(k, Z, wo, wi), value.pdf(k, Z, wo, wi)
    return f[0] * np.maximum(dot(Z, wi), 0) / pdf, wi


@pytest.mark.parametrize("n", EXPONENTS)
@pytest.mark.parametrize("degrees", [0, 45, 80])
def test_every_sample_above_the_horizon_weighs_the_same(n, degrees):
    """k_s (n + 2) / (n + 1), the largest factor that there is: no fireflies, and at normal incidence no noise."""
    weight, wi = weights(PhongLecture((0.5, 0.3, 0.1), n), np.radians(degrees))
    # Below, the cosine of a sample is the rounding of directions and is not divided by.
    above = wi[2] > 2.0**-24
    np.testing.assert_allclose(weight[above], 0.5 * (n + 2) / (n + 1), rtol=1e-9)
    assert (weight[wi[2] <= 0] == 0).all()
    assert weight.max() <= albedo_of(PhongLecture((0.5, 0.3, 0.1), n))[0] * (1 + 1e-9)


@pytest.mark.parametrize("n", EXPONENTS)
def test_at_normal_incidence_more_is_reflected_than_the_reflectance(n):
    """Albedo k_s (n + 2) / (n + 1), twice k_s for n = 0: what `albedo` declares, so that validation refuses more."""
    weight, _ = weights(PhongLecture((0.5,) * 3, n), 0.0)
    assert weight.mean() == pytest.approx(0.5 * (n + 2) / (n + 1), rel=1e-6)
    assert albedo_of(PhongLecture((0.5,) * 3, n))[0] == pytest.approx(0.5 * (n + 2) / (n + 1), rel=1e-12)


@pytest.mark.parametrize(("n", "degrees", "share"), [(0.0, 60, 2 / 3), (0.0, 90, 0.5), (1.0, 90, 0.5), (1e3, 90, 0.5), (1e6, 60, 1.0)])
def test_the_rest_of_the_lobe_is_below_the_horizon(n, degrees, share):
    """The share of the lobe above: a half at grazing for each n, and 1 - theta / pi for n = 0; detects 2 %."""
    weight, _ = weights(PhongLecture((0.5,) * 3, n), np.radians(degrees))
    assert h.mean_is(weight, 0.5 * (n + 2) / (n + 1) * share, floor=1e-6)


def test_the_shares_catch_the_reciprocal_lobe():
    """Phong without the division is 12 % short at 45 degrees and n = 10."""
    weight, _ = weights(Phong((0.5,) * 3, 10.0), np.radians(45))
    assert not h.mean_is(weight, 0.5 * 12 / 11, floor=1e-3)


def test_a_highlight_is_that_of_the_illumination_model():
    """f cos = k_s (n + 2) / (2 pi) (r . l)^n: Phong's own term, free of the cosine of incidence."""
    value, wo = PhongLecture((0.5, 0.3, 0.1), 10.0), h.at_angle(0.8)
    wi = h.directions(2, 1_000)
    wi[2] = np.abs(wi[2])
    mirror = np.array([[-1.0], [-1.0], [1.0]]) * wo
    truth = 12 / (2 * np.pi) * np.maximum(dot(mirror, wi), 0) ** 10
    f = value.eval(h.table(value.row()), Z, wo, wi)
    np.testing.assert_allclose(f * wi[2], np.array([[0.5], [0.3], [0.1]]) * truth, rtol=1e-9, atol=1e-12)
    term = value.illuminate(h.table(value.row()), Z, wo, wi)
    np.testing.assert_allclose(f * wi[2], term * 12 / (2 * np.pi), rtol=1e-9, atol=1e-12)


def test_it_really_is_not_reciprocal():
    """f(a, b) / f(b, a) is the ratio of the cosines."""
    k = h.table(PhongLecture((0.5,) * 3, 10.0).row())
    a, b = h.at_angle(0.3), h.at_angle(1.1, np.pi)
    ratio = PhongLecture.eval(k, Z, a, b) / PhongLecture.eval(k, Z, b, a)
    assert ratio[0, 0] == pytest.approx(np.cos(0.3) / np.cos(1.1), rel=1e-12)


def test_materials_may_not_reflect_more_than_arrives():
    """k_s up to (n + 1) / (n + 2) is allowed, and one ten-thousandth more is refused by name."""
    for n in (0.0, 10.0):
        most = (n + 1) / (n + 2)
        for k_s, is_allowed in ((most, True), (most * 1.0001, False)):
            material = Material(name="gloss", lobes=(PhongLecture((k_s,) * 3, n),))
            scene = h.scene([h.thing(h.quad(), material)])
            if is_allowed:
                validate(scene, h.settings())
            else:
                with pytest.raises(SceneError, match="material 'gloss' reflects"):
                    validate(scene, h.settings())


@pytest.mark.parametrize("exponent", [-1.0, -2.0, float("nan")])
def test_senseless_exponents_are_refused_by_name_before_they_are_computed_with(exponent):
    material = Material(name="gloss", lobes=(PhongLecture((0.5,) * 3, exponent),))
    with pytest.raises(SceneError, match="material 'gloss': Phong exponent"):
        validate(h.scene([h.thing(h.quad(), material)]), h.settings())
