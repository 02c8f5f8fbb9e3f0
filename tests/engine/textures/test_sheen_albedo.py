"""Sheen reflects as much as its models do; those of fibres are compared with Cycles in tests/parity/test_closures.py."""

import numpy as np
import pytest

from glanz.engine import GgxAlbedo, SceneError, SheenAlbedo
from glanz.engine.maths.fresnel import fresnel_conductor
from glanz.engine.scene.points import Probes
from glanz.engine.textures import sheen_albedo

SIDE = 200
METALS = {
    "copper": ((0.2004, 0.9240, 1.1022), (3.9129, 2.4528, 2.1422)),
    "silver": ((0.05, 0.06, 0.05), (4.4, 3.6, 2.7)),
    "iron": ((2.9, 2.88, 2.6), (3.1, 2.95, 2.8)),
}


def seen(texture):
    """Cosines (N,), and what the texture is there (C, N)."""
    probes = Probes()
    return -probes.d[2], probes.value(texture)


def velvet(r, cos):
    """Ashikhmin's, by quadrature of f |cos| = D G / (4 cos_o) over directions of light."""
    u = (np.arange(SIDE) + 0.5) / SIDE
    z, phi = np.meshgrid(u, 2 * np.pi * u)
    wi = np.stack((np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z))
    wo = np.array((np.sqrt(1 - cos * cos), 0, cos))[:, None, None]
    half = wo + wi
    half /= np.linalg.norm(half, axis=0)
    up, across = half[2], (half * wo).sum(axis=0)
    sin2 = 1 - up * up
    density = np.exp(-up * up / (sin2 * r * r)) / (np.pi * r * r * sin2 * sin2)
    masking = np.minimum(1, 2 * up * np.minimum(cos, z) / across)
    return (density * masking / (4 * cos)).mean() * 2 * np.pi


def check_velvet():
    for r in (0.1, 0.3, 0.6, 1.0):
        cos, albedo = seen(SheenAlbedo(r, "ashikhmin"))
        lanes = np.nonzero(cos > 0.05)[0][::16]
        expected = [velvet(r, cos[lane]) for lane in lanes]
        assert (np.abs(albedo[0, lanes] - expected) <= 0.02).all(), r


def test_velvet_is_what_quadrature_says():
    check_velvet()


def test_velvet_of_the_other_kind_is_noticed(monkeypatch):
    monkeypatch.setitem(sheen_albedo._FITS, "ashikhmin", sheen_albedo._FITS["microfiber"])
    with pytest.raises(AssertionError):
        check_velvet()


@pytest.mark.parametrize("kind", sheen_albedo._FITS)
@pytest.mark.parametrize("roughness", [-1.0, 0.0, 0.01, 0.2, 1.0, 7.0, float("nan")])
def test_no_more_is_reflected_than_arrives_and_most_at_the_rim(kind, roughness):
    cos, albedo = seen(SheenAlbedo(roughness, kind))
    albedo = albedo[0, np.argsort(cos)]
    assert (albedo >= 0).all()
    assert (albedo <= 1).all()
    assert (albedo <= np.minimum.accumulate(albedo) + 0.01).all()


def test_a_kind_that_is_not_known_is_refused():
    with pytest.raises(SceneError, match="kind of its sheen is 'wool', allowed: microfiber, ashikhmin"):
        SheenAlbedo(kind="wool").check("material 'Coat'")


@pytest.mark.parametrize("name", METALS)
def test_a_conductor_reflects_as_fresnel_says_where_it_is_nearly_smooth(name):
    """To 0.025 at all angles but the last six degrees: Schlick's form has the right values at two."""
    ior, extinction = METALS[name]
    cos, albedo = seen(GgxAlbedo(0.0, ior, extinction=extinction, kind="conductor"))
    exact = fresnel_conductor(cos, *(np.array(a)[:, None] for a in (ior, extinction)))
    lanes = cos > 0.1
    assert (np.abs(albedo - exact)[:, lanes] <= 0.025).all()
    straight = cos > 0.995
    assert (np.abs(albedo - exact)[:, straight] <= 1e-3).all()
