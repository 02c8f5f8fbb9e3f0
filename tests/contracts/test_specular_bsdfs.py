"""What every BSDF without a width promises (`interfaces.SpecularBsdf`), for every such class in the registry."""

import dataclasses

import numpy as np
import pytest

from glanz.engine import Dielectric, SceneError
from glanz.engine.interfaces import SpecularBsdf, albedo_of
from glanz.engine.registry import BSDFS
from glanz.tests import helpers as h

CONSTANT = Dielectric(1.5, (0.3,) * 3, (0.7,) * 3, is_fresnel=False)
TINTED = Dielectric(1.5, (0.1, 0.4, 0.0), (0.8, 0.3, 0.7), is_fresnel=False)
EXAMPLES = {"dielectric": [*(Dielectric(ior) for ior in (1e-3, 1 / 1.5, 1.0, 1 + 1e-12, 1.5, 2.42, 1e3)), CONSTANT]}
ALL = [value for key, plugin in BSDFS.items() if plugin.is_specular for value in EXAMPLES.get(key, [plugin()])]
ANGLES = (0.0, 0.4, 0.8, 1.2, np.pi / 2 - 1e-3, np.pi / 2 - 1e-7)
Z = np.array([[0.0], [0.0], [1.0]])

each = pytest.mark.parametrize("value", ALL, ids=str)


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
    assert max(albedo_of(value)) <= 1
    assert not any(albedo_of(type(value).black()))


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


def check_branches(value, angle, is_front):
    """The branches are distinct directions, and each weighs what `scatter` gives it on average, to 1 / n."""
    n = 4_000
    wo, wi, weight = scattered(value, angle, is_front, n)
    k = h.table(value.row())
    branches = value.branches(k, Z, wo[:, :1], np.array([is_front]))
    found = np.zeros(n, bool)
    for direction, share in branches:
        mine = np.abs(wi - direction).max(axis=0) <= 1e-9
        # Two branches along one line: only where nothing goes along the other.
        assert not (found & mine & (share > 0).any()).any()
        found |= mine
        assert np.broadcast_to(share, (3, 1))[:, 0] == pytest.approx((weight * mine).sum(axis=1) / n, abs=weight.max() / n)
    assert found.all()


@pytest.mark.parametrize("value", [*ALL, TINTED, Dielectric(1.5, (0.2, 0.5, 0.0), (0.9, 0.5, 0.3))], ids=str)
@pytest.mark.parametrize("is_front", [True, False])
def test_branches_are_what_scattering_does_on_average(value, is_front):
    for angle in ANGLES[:-1]:
        check_branches(value, angle, is_front)


def test_the_average_catches_branches_that_are_not_scaled(monkeypatch):
    """The missing 1 / eta^2 of the refracted branch; and constants that forget total reflection."""
    original = Dielectric.branches
    for value, changed in ((Dielectric(1.5), lambda a, b: (a, (b[0], b[1] * 2.25))), (CONSTANT, lambda a, b: ((a[0], a[1] * 0.3), b))):
        monkeypatch.setattr(Dielectric, "branches", staticmethod(lambda *args, changed=changed: changed(*original(*args))))
        with pytest.raises(AssertionError):
            check_branches(value, 1.2, value is not CONSTANT)


@pytest.mark.parametrize("is_front", [True, False])
def test_an_index_for_each_channel_gives_each_its_own_branch(is_front):
    """Together they weigh what one index does, and each goes where its index sends it, red alone, green alone, blue alone."""
    indices = (1.3, 1.5, 1.7)
    wo = h.at_angle(0.5, 0.3)
    k = h.table(Dielectric(1.5, (0.9,) * 3, (0.8,) * 3).row())
    k.ior = np.array(indices)[:, None]
    reflected, *refracted = Dielectric.branches(k, Z, wo, np.array([is_front]))
    assert len(refracted) == 3
    for c, (index, (wi, weight)) in enumerate(zip(indices, refracted)):
        k.ior = np.array([index])
        mirrored, passed = Dielectric.branches(k, Z, wo, np.array([is_front]))
        assert wi == pytest.approx(passed[0], abs=1e-12)
        assert weight[c] == pytest.approx(passed[1][c], rel=1e-12)
        assert not np.delete(weight, c, axis=0).any()
        assert reflected[1][c] == pytest.approx(mirrored[1][c], rel=1e-12)


@pytest.mark.parametrize("angle", [0.5, 1.2])
def test_constants_share_light_as_the_lecture_has_it(angle):
    """k_r goes to the mirror direction and k_t, scaled, through; from inside beyond 0.73 rad all of both is reflected."""
    (_, outside), (_, through) = Dielectric.branches(h.table(TINTED.row()), Z, h.at_angle(angle), np.array([True]))
    assert outside[:, 0] == pytest.approx(TINTED.reflectance)
    assert through[:, 0] * 2.25 == pytest.approx(TINTED.transmittance)
    (_, inside), (_, out) = Dielectric.branches(h.table(TINTED.row()), Z, h.at_angle(angle), np.array([False]))
    assert inside[:, 0] == pytest.approx(TINTED.reflectance if angle < 0.73 else albedo_of(TINTED))
    assert out[:, 0] / 2.25 == pytest.approx(TINTED.transmittance if angle < 0.73 else (0, 0, 0))


@each
def test_dtype_is_kept(value):
    for dtype in (np.float32, np.float64):
        wo, wi, weight = scattered(value, 0.7, True, 16, dtype)
        assert wi.dtype == weight.dtype == dtype
        for direction, share in value.branches(h.table(value.row(), dtype), Z.astype(dtype), wo, np.full(16, True)):
            assert direction.dtype == share.dtype == dtype


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
