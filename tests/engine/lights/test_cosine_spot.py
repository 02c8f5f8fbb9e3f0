"""The lecture's spot against closed forms (catalogue E2)."""

import math

import numpy as np
import pytest

from glanz.engine import CosineSpotLight, PointLight, SceneError
from glanz.engine.lights import cosine_spot
from glanz.engine.maths.vectors import dot
from glanz.engine.scene.validate import validate
from glanz.tests import chance, helpers as h

EXPONENTS = (0.0, 0.5, 1.0, 10.0, 1e3, 1e6)


def intensity(light, theta, dtype=np.float64):
    """I [W sr^-1] of a point light at the angles theta (N,) from its axis: E d^2 at distance 2, as `sample` has it."""
    frame = np.asarray(light.world_from_light)[:3, :3]
    away = frame @ np.stack((np.sin(theta), 0 * theta, -np.cos(theta)))
    p = np.array(light.position)[:, None] + 2 * away
    _, distance, E, _ = light.sample(h.table(light.row(h.UNIT_FRAME), dtype), p.astype(dtype), np.full((2, theta.size), 0.5, dtype))
    assert distance == pytest.approx(2, rel=1e-6)
    return E[0] * 4


@pytest.mark.parametrize("n", EXPONENTS)
def test_the_intensity_is_a_power_of_the_cosine(n):
    """I_0 max(cos, 0)^n, to 1e-9 of I_0, from the axis to behind the light; float32 to the rounding of directions."""
    light = CosineSpotLight(world_from_light=h.affine(h.rotation(7), (0.3, 0.2, 0.1)), intensity=(9.0, 1.0, 1.0), exponent=n)
    theta = np.concatenate((np.linspace(0, 1.5, 40), 2.0 ** -np.arange(2, 20), [1.6, 2.5, math.pi]))
    in_front = theta < math.pi / 2
    truth = 9 * in_front * np.exp(n * np.log1p(-2 * np.sin(np.where(in_front, theta, 0) / 2) ** 2))
    np.testing.assert_allclose(intensity(light, theta), truth, atol=9e-9)
    np.testing.assert_allclose(intensity(light, theta, np.float32), truth, atol=9 * (1e-6 + 1e-7 * np.sqrt(n)))


@pytest.mark.parametrize("n", EXPONENTS)
def test_the_flux_has_a_closed_form(n):
    """2 pi I_0 / (n + 1) against Gauss-Legendre over the sphere of `intensity`, to 1e-6."""
    light = CosineSpotLight(intensity=(3.0, 2.0, 1.0), exponent=n)
    x, weight = np.polynomial.legendre.leggauss(32)
    edges = np.concatenate(([0.0], 2.0 ** -np.arange(20, -1, -1.0), [2.0]))
    half = np.diff(edges) / 2
    q = (edges[:-1] + half)[:, None] + half[:, None] * x
    flux = 2 * math.pi * (intensity(light, np.arccos(1 - q.ravel())).reshape(q.shape) * weight * half[:, None]).sum()
    # arccos loses digits near the axis: 1e-16 / q.
    assert light.power()[0] == pytest.approx(flux, rel=1e-3 if n == 1e6 else 1e-5)
    assert light.power() == pytest.approx(tuple(2 * math.pi * c / (n + 1) for c in (3, 2, 1)), rel=1e-12)


@pytest.mark.parametrize("mutant", ["one more", "half angle", "behind as well"])
def test_the_closed_forms_catch_another_characteristic(monkeypatch, mutant):
    power = {
        "one more": lambda a, b, n: np.maximum(dot(a, b), 0) ** (n + 1),
        "half angle": lambda a, b, n: (0.5 + 0.5 * dot(a, b)) ** n,
        "behind as well": lambda a, b, n: np.abs(dot(a, b)) ** n,
    }[mutant]
    monkeypatch.setattr(cosine_spot, "cosine_power", power)
    for law in (test_the_intensity_is_a_power_of_the_cosine, test_the_flux_has_a_closed_form):
        with pytest.raises(AssertionError):
            law(1.0)


@chance.fresh
def test_photons_balance_in_a_room():
    """F3: all of the flux 2 pi I_0 / (n + 1) lands on the walls of a closed room; mean irradiance Phi / A, detects 1 %."""
    light = CosineSpotLight(world_from_light=h.affine(h.rotation(2), (0.2, -0.1, 0.3)), intensity=(5.0,) * 3, exponent=6.0)
    k, n = h.table(light.row(h.UNIT_FRAME)), 200_000
    rng = np.random.default_rng(chance.seeded(1))
    axis, sign = rng.integers(0, 3, n), rng.choice((-1.0, 1.0), n)
    p = rng.uniform(-1, 1, (3, n))
    p[axis, np.arange(n)] = sign
    wi, _, E, _ = light.sample(k, p, h.uniform(2, n))
    received = E[0] * np.maximum(-sign * wi[axis, np.arange(n)], 0)
    assert h.mean_is(received, light.power()[0] / 24)


def test_a_large_bulb_gives_what_the_point_gives_on_the_axis():
    """Exponent 0 in front of the light is the point light, bulb and ball alike."""
    for radius, soft in ((0.0, True), (0.5, True), (0.5, False)):
        common = {"intensity": (7.0,) * 3, "radius": radius, "soft_falloff": soft}
        light = CosineSpotLight(world_from_light=h.affine(translation=(0, 0, 2)), exponent=0.0, **common)
        point = PointLight(position=(0, 0, 2), **common)
        p, u2 = np.zeros((3, 1_000)), h.uniform(1, 1_000)
        for a, b in zip(light.sample(h.table(light.row(h.UNIT_FRAME)), p, u2), point.sample(h.table(point.row(h.UNIT_FRAME)), p, u2)):
            np.testing.assert_allclose(a, b, rtol=1e-12)


def test_scale_does_not_matter():
    """As the lecture has a direction and an angle: a stretched frame gives the same light."""
    turn = h.rotation(3)
    for scale in (np.diag((2.0, 3.0, 0.5)), np.diag((1.0, 1.0, 1e-6))):
        a, b = (CosineSpotLight(world_from_light=h.affine(m)) for m in (turn, turn @ scale))
        assert a.axis == pytest.approx(b.axis, rel=1e-12)


@pytest.mark.parametrize("exponent", [-1.0, -0.5, 1e7])
def test_senseless_exponents_are_refused_by_name(exponent):
    with pytest.raises(SceneError, match="light 'Beam': exponent"):
        validate(h.scene(lights=[CosineSpotLight(name="Beam", exponent=exponent)]), h.settings())


def test_what_is_not_a_number_is_left_out_by_name():
    _, warnings = validate(h.scene(lights=[CosineSpotLight(name="Beam", exponent=float("nan"))]), h.settings())
    (warning,) = warnings
    assert warning.datablock == ("light", "Beam") and warning.is_lost
