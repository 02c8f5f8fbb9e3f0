"""What every BSDF without a width promises (`interfaces.SpecularBsdf`), for every such class in the registry."""

import dataclasses

import numpy as np
import pytest

from glanz.engine import Dielectric, SceneError
from glanz.engine.interfaces import SpecularBsdf
from glanz.engine.registry import BSDFS
from glanz.tests import helpers as h

EXAMPLES = {"dielectric": [Dielectric(ior) for ior in (1e-3, 1 / 1.5, 1.0, 1 + 1e-12, 1.5, 2.42, 1e3)]}
ALL = [value for key, plugin in BSDFS.items() if plugin.is_specular for value in EXAMPLES.get(key, [plugin()])]
ANGLES = (0.0, 0.4, 0.8, 1.2, np.pi / 2 - 1e-3, np.pi / 2 - 1e-7)
Z = np.array([[0.0], [0.0], [1.0]])

each = pytest.mark.parametrize("value", ALL, ids=lambda v: f"{v.key}-{getattr(v, 'ior', '')}")


def scattered(value, angle, is_front, n=1_000, dtype=np.float64):
    """wo (3, n), wi (3, n), weight (3, n) at `angle` from z; u1 is stratified, so shares are exact to 1 / n."""
    wo = np.repeat(h.at_angle(angle, 0.3, dtype), n, axis=1)
    u1 = ((np.arange(n) + 0.5) / n).astype(dtype)
    wi, weight = value.scatter(h.table(value.row(), dtype), np.repeat(Z, n, 1).astype(dtype), wo, np.full(n, is_front), u1)
    return wo, wi, np.broadcast_to(weight, wi.shape)


@each
def test_a_specular_bsdf_offers_the_interface(value):
    assert isinstance(value, SpecularBsdf)
    assert value.is_specular
    assert value.label
    value.check("material")
    assert max(value.albedo()) <= 1
    assert not any(type(value).black().albedo())


@each
@pytest.mark.parametrize("is_front", [True, False])
def test_directions_are_unit_and_lie_in_the_plane_of_incidence(value, is_front):
    for angle in ANGLES:
        wo, wi, weight = scattered(value, angle, is_front)
        assert np.isfinite(wi).all()
        assert np.isfinite(weight).all()
        assert (weight >= 0).all()
        assert np.abs(np.linalg.norm(wi, axis=0) - 1).max() <= 1e-12
        across = np.cross(wo.T, Z.T)
        assert np.abs((across * wi.T).sum(axis=1)).max() <= 1e-12


@each
@pytest.mark.parametrize("is_front", [True, False])
def test_a_specular_bsdf_passes_on_all_light_and_no_more(value, is_front):
    """In even radiance 1 a surface without tint looks like 1: weights that cross by eta^2 towards their side."""
    eta = getattr(value, "ior", 1.0) if is_front else 1 / getattr(value, "ior", 1.0)
    for angle in ANGLES:
        _, wi, weight = scattered(value, angle, is_front)
        passed = np.where(wi[2] < 0, weight[0] * eta * eta, weight[0])
        assert passed == pytest.approx(1, rel=1e-9)


@each
def test_dtype_is_kept(value):
    for dtype in (np.float32, np.float64):
        _, wi, weight = scattered(value, 0.7, True, 16, dtype)
        assert wi.dtype == weight.dtype == dtype


@each
def test_lanes_are_independent(value):
    n = 101
    wo, u1 = h.directions(3, n, np.float32), h.uniform(4, n, np.float32)[0]
    wo[2] = np.abs(wo[2])
    front, normal, k = np.arange(n) % 2 == 0, np.repeat(Z, n, 1).astype(np.float32), h.table(value.row(), np.float32)
    whole, weight = value.scatter(k, normal, wo, front, u1)
    for lane in (0, 1, 50, 100):
        one = slice(lane, lane + 1)
        parts = [np.ascontiguousarray(a[..., one]) for a in (normal, wo, front, u1)]
        alone, alone_weight = value.scatter(k, *parts)
        assert h.same_bits(alone, whole[:, one])
        assert h.same_bits(np.broadcast_to(alone_weight, (3, 1)), np.broadcast_to(weight, whole.shape)[:, one])


@pytest.mark.parametrize("ior", [0.0, -1.5, float("nan"), float("inf"), 1e4])
def test_senseless_indices_are_refused_by_name(ior):
    with pytest.raises(SceneError, match=r"material 'Pane'.*index of refraction"):
        Dielectric(ior).check("Pane")


def test_the_balance_catches_radiance_that_is_not_scaled(monkeypatch):
    """The missing 1 / eta^2 (D18) is a factor of 2.25."""
    value = Dielectric(1.5)
    unscaled = staticmethod(lambda k, n, wo, front, u1: (Dielectric.scatter(k, n, wo, front, u1)[0], np.ones_like(wo)))
    mutant = dataclasses.make_dataclass("Mutant", [], bases=(Dielectric,), frozen=True, namespace={"scatter": unscaled})(value.ior)
    test_a_specular_bsdf_passes_on_all_light_and_no_more(value, True)
    with pytest.raises(AssertionError):
        test_a_specular_bsdf_passes_on_all_light_and_no_more(mutant, True)
