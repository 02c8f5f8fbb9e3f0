"""Lambert reflection against its closed form (catalogue C1)."""

import numpy as np
import pytest

from glanz.engine import Lambert
from glanz.engine.maths.vectors import dot
from glanz.tests import helpers as h

Z = h.unit(0, 0, 1)


def test_the_reflected_share_is_the_reflectance():
    """Integral of f cos over the hemisphere, Gauss-Legendre: to 1e-12."""
    k = h.table(Lambert((0.8, 0.5, 0.1)).row())
    x, weight = np.polynomial.legendre.leggauss(8)
    z = 0.5 * (x + 1)
    w = np.stack((np.sqrt(1 - z * z), np.zeros(8), z))
    f = np.broadcast_to(Lambert.eval(k, Z, h.at_angle(0.3), w), (3, 8))
    np.testing.assert_allclose((f * z * weight).sum(axis=1) * 0.5 * 2 * np.pi, (0.8, 0.5, 0.1), rtol=1e-12)


def test_every_sample_weighs_the_reflectance():
    """f cos / pdf = k_d for each sample: no noise from sampling."""
    n = 100_000
    k = h.table(Lambert((0.8, 0.5, 0.1)).row())
    wo = h.at_angle(0.3)
    wi = Lambert.sample(k, np.repeat(Z, n, 1), wo, h.uniform(1, n))
    weight = Lambert.eval(k, Z, wo, wi) * dot(Z, wi) / Lambert.pdf(k, Z, wo, wi)
    np.testing.assert_allclose(weight, np.broadcast_to([[0.8], [0.5], [0.1]], weight.shape), rtol=1e-12)


def test_the_value_does_not_depend_on_directions():
    k = h.table(Lambert((0.8, 0.5, 0.1)).row())
    f = Lambert.eval(k, Z, h.at_angle(0.3), h.at_angle(1.2))
    assert f.ravel() == pytest.approx(np.array((0.8, 0.5, 0.1)) / np.pi, rel=1e-15)


@pytest.mark.parametrize(
    "law", [test_the_reflected_share_is_the_reflectance, test_every_sample_weighs_the_reflectance], ids=lambda x: x.__name__
)
def test_the_closed_forms_catch_a_missing_pi(monkeypatch, law):
    monkeypatch.setattr(Lambert, "eval", staticmethod(lambda k, n, wo, wi: k.reflectance * np.ones_like(dot(n, wi))))
    with pytest.raises(AssertionError):
        law()
