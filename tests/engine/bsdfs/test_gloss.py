"""Lobes that reflect, or pass, exactly the share that they are told to, from wherever they are seen."""

import numpy as np
import pytest

from glanz.engine import Gloss, RoughRefraction
from glanz.engine.bsdfs import gloss
from glanz.engine.maths.vectors import dot
from glanz.tests import helpers as h
from glanz.tests.bsdf_laws import NORMAL, viewer

ANGLES = (0.0, 0.8, 1.4, 1.55)


def share(value, k, angle, side, n=200_000):
    """What goes to one `side` of the surface, a mean over directions as the lobe samples them, (n,)."""
    wo, normal = np.repeat(viewer(angle), n, 1), np.repeat(NORMAL, n, 1)
    wi = value.sample(k, normal, wo, h.uniform(7, n))
    cos = side * dot(normal, wi)
    with np.errstate(divide="ignore", invalid="ignore"):
        weight = value.eval(k, normal, wo, wi)[0] * cos / value.pdf(k, normal, wo, wi)
    return np.where(cos > 0, weight, 0)


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("exponent", [0.0, 5.0, 200.0])
def test_all_is_reflected_whatever_the_angle(exponent, angle):
    value = Gloss((1.0, 1.0, 1.0), exponent)
    assert h.mean_is(share(value, h.table(value.row()), angle, 1), 1.0, floor=2.0**-7)


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("eta", [1.0, 1.5, 1 / 1.5])
def test_all_passes_and_its_radiance_is_that_of_the_other_medium(eta, angle):
    value = RoughRefraction((1.0, 1.0, 1.0), 20.0, eta)
    assert h.mean_is(share(value, h.table(value.row()), angle, -1) * eta**2, 1.0)


def test_what_is_lost_below_the_surface_is_noticed(monkeypatch):
    value = Gloss((1.0, 1.0, 1.0), 5.0)
    monkeypatch.setattr(gloss, "_left", lambda exponent, cos: np.ones_like(cos))
    assert not h.mean_is(share(value, h.table(value.row()), 1.4, 1), 1.0, floor=2.0**-7)


@pytest.mark.parametrize("exponent", [0.0, 1.0, 20.0])
def test_reflected_light_fades_towards_the_horizon_of_its_source(exponent):
    """So that wide lobes have no hard edge where a lamp sets: f |cos| falls with the cosine."""
    value = Gloss((1.0, 1.0, 1.0), exponent)
    k, wo = h.table(value.row()), viewer(0.7)
    along = wo - dot(wo, NORMAL) * NORMAL
    along /= np.linalg.norm(along)
    low = [c * NORMAL - np.sqrt(1 - c * c) * along for c in (0.01, 0.001)]
    first, second = (float(value.eval(k, NORMAL, wo, wi)[0, 0] * dot(NORMAL, wi)[0]) for wi in low)
    assert second <= 0.12 * first


def reflected(exponent, cos, side=600):
    """The share that a lobe of k_s = 1 reflects, a mean over numbers on a fine grid."""
    value = Gloss((1.0, 1.0, 1.0), exponent)
    u2 = (np.stack(np.meshgrid(np.arange(side), np.arange(side))).reshape(2, -1) + 0.5) / side
    normal = np.broadcast_to(np.array([[0.0], [0.0], [1.0]]), (3, side * side))
    wo = np.broadcast_to(np.array([[np.sqrt(1 - cos * cos)], [0.0], [cos]]), normal.shape)
    k = h.table(value.row())
    wi = value.sample(k, normal, wo, u2)
    return np.where(wi[2] > 0, value.eval(k, normal, wo, wi)[0] * wi[2] / value.pdf(k, normal, wo, wi), 0).mean()


EXPONENTS = (0.0, 0.05, 0.33, 0.5, 0.77, 0.95, 1.0, 1.05, 3.3, 12.0, 216.0, 1e4, 1e6)
COSINES = (0.0, 0.001, 0.03, 0.1, 0.33, 0.71, 0.9, 1.0)


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_between_the_entries_of_the_table_all_but_half_a_percent_is_reflected_and_never_more(exponent):
    found = [reflected(exponent, cos) for cos in COSINES]
    assert max(found) <= 1
    assert min(found) >= 0.995


def test_what_is_reflected_catches_a_table_that_is_too_coarse(monkeypatch):
    monkeypatch.setattr(gloss, "_NARROW", 12)
    monkeypatch.setattr(gloss, "_WIDTHS", 17)
    gloss._table.cache_clear()
    try:
        with pytest.raises(AssertionError):
            test_between_the_entries_of_the_table_all_but_half_a_percent_is_reflected_and_never_more(0.5)
    finally:
        gloss._table.cache_clear()
