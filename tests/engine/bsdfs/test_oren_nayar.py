"""Rough diffuse reflection against its limits, its closed albedo, and the formulas as they are published."""

import numpy as np
import pytest

from glanz.engine import Lambert, OrenNayar, SceneError
from glanz.tests import helpers as h

Z = h.unit(0, 0, 1)
WHITE = (1.0, 1.0, 1.0)
ANGLES = (0.0, 0.4, 1.1, 1.5, np.pi / 2 - 1e-3, np.pi / 2 - 1e-7)


def share(value, angle, order=40):
    """The share (3,) of light that `value` reflects towards a viewer at `angle`, by quadrature between the kinks of f."""
    x, weight = np.polynomial.legendre.leggauss(order)
    total = np.zeros(3)
    for low, high in ((0, angle), (angle, np.pi / 2)):
        theta = low + (high - low) * 0.5 * (x + 1)
        # The other half of the azimuths, from 0 to -pi, is the same.
        for start in (0, np.pi / 2):
            phi = start + np.pi / 4 * (x + 1)
            t, p = (a.ravel() for a in np.meshgrid(theta, phi, indexing="ij"))
            w = np.outer(weight * (high - low) / 2, weight * np.pi / 4).ravel()
            wi = np.stack((np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)))
            f = value.eval(h.table(value.row()), Z, h.at_angle(angle), wi)
            total += 2 * (f * w * np.cos(t) * np.sin(t)).sum(axis=1)
    return total


def published(r, colour, again, wo, wi):
    """f (3, N), float64, as the paper's listing has it but for Blender's colour of what is reflected again; z is the normal."""
    rim, mean = 0.5 - 2 / (3 * np.pi), 2 / 3 - 28 / (15 * np.pi)
    a = 1 / (1 + rim * r)

    def albedo(cos):
        sin = np.sqrt(1 - cos * cos)
        g = sin * (np.arccos(cos) - sin * cos) + 2 / 3 * (sin / cos * (1 - sin**3) - sin)
        return a + r * a / np.pi * g

    s = (wo * wi).sum(axis=0) - wo[2] * wi[2]
    t = np.where(s > 0, np.maximum(wo[2], wi[2]), 1)
    e = a * (1 + mean * r)
    again = np.square(again)[:, None] * e / (1 - np.multiply(again, 1 - e))[:, None]
    return np.array(colour)[:, None] / np.pi * (a * (1 + r * s / t) + again * (1 - albedo(wo[2])) * (1 - albedo(wi[2])) / (1 - e))


def above(seed, n=20_000):
    """Unit vectors (3, n) above the horizon, down to cosines of 1e-4."""
    w = h.directions(seed, n)
    w[2, ::4] *= 10.0 ** -np.random.default_rng(seed).uniform(1, 4, n // 4)
    w[2] = np.maximum(np.abs(w[2]), 1e-4)
    return w / np.linalg.norm(w, axis=0)


def test_without_roughness_it_is_lambert_to_the_bit():
    wo, wi = h.directions(1, 1000, np.float32), h.directions(2, 1000, np.float32)
    rough, plain = OrenNayar((0.8, 0.5, 0.1), 0.0), Lambert((0.8, 0.5, 0.1))
    f = rough.eval(h.table(rough.row(), np.float32), Z.astype(np.float32), wo, wi)
    expected = plain.eval(h.table(plain.row(), np.float32), Z.astype(np.float32), wo, wi)
    assert h.same_bits(f, np.broadcast_to(expected, (3, 1000)).copy())


@pytest.mark.parametrize("roughness", [0.0, 0.3, 1.0])
def test_what_is_white_reflects_everything(roughness):
    """The furnace, at every angle, to 1e-8."""
    for angle in ANGLES:
        np.testing.assert_allclose(share(OrenNayar(WHITE, roughness, WHITE), angle), 1, rtol=1e-8)


def test_what_is_reflected_once_is_the_closed_form():
    """A of the module's docstring seen from above, and all along the surface."""
    once = OrenNayar(WHITE, 1.0, (0.0, 0.0, 0.0))
    np.testing.assert_allclose(share(once, 0.0), 1 / (1.5 - 2 / (3 * np.pi)), rtol=1e-9)
    np.testing.assert_allclose(share(once, np.pi / 2 - 1e-7), 1, rtol=1e-6)


def test_a_furnace_without_what_is_reflected_again_is_noticed(monkeypatch):
    monkeypatch.setattr("glanz.engine.bsdfs.oren_nayar._MEAN", 0.08)
    with pytest.raises(AssertionError):
        test_what_is_white_reflects_everything(1.0)


@pytest.mark.parametrize("roughness", [1e-3, 0.5, 1.0])
def test_single_precision_is_as_published(roughness):
    """Also along the surface, where 1 - E and tan (1 - sin^3) cancel."""
    wo, wi = above(3), above(4)
    value = OrenNayar((0.9, 0.5, 0.1), roughness, (1.0, 0.5, 0.0))
    f = value.eval(h.table(value.row(), np.float32), Z.astype(np.float32), wo.astype(np.float32), wi.astype(np.float32))
    expected = published(roughness, value.reflectance, value.again, wo, wi)
    # s is a difference of numbers up to 1, rounded to 2^-24, over t.
    rounding = 2.0**-21 * (1 + roughness / np.maximum(wo[2], wi[2])) * np.array(value.reflectance)[:, None]
    assert (np.abs(f - expected) <= rounding).all()


def test_numbers_out_of_range_are_refused_by_name():
    for roughness in (-0.1, 1.5, float("nan")):
        with pytest.raises(SceneError, match=r"material 'clay': roughness of Oren-Nayar is"):
            OrenNayar(roughness=roughness).check("clay")
    with pytest.raises(SceneError, match=r"material 'clay': colour of further reflections is \(0.5, 2.0, 0.5\), allowed"):
        OrenNayar(again=(0.5, 2.0, 0.5)).check("clay")
