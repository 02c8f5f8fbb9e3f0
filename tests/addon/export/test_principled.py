"""The Principled split keeps energy and meets the limits that have names."""

import itertools

import numpy as np
import pytest

from glanz.addon.export.principled import average_fresnel, effective_ior, principled_lobes
from glanz.engine import albedo_of

STEPS = (0.0, 0.3, 1.0)


@pytest.mark.parametrize(("metallic", "level"), list(itertools.product(STEPS, STEPS)))
def test_the_lobes_never_reflect_more_than_arrives(metallic, level):
    for base, ior, tint in itertools.product(((0, 0, 0), (1, 1, 1), (1, 0.5, 0)), (1.0, 1.5, 4.0), ((1, 1, 1), (1, 0, 0))):
        total = np.sum([albedo_of(lobe) for lobe in principled_lobes(base, metallic, 0.5, ior, level, tint)], axis=0)
        assert (total <= 1 + 1e-12).all()
        assert (total >= 0).all()


def test_a_white_base_under_a_white_coat_reflects_everything():
    lobes = principled_lobes((1, 1, 1), 0.0, 0.5, 1.5, 0.5)
    assert np.sum([albedo_of(lobe) for lobe in lobes], axis=0) == pytest.approx([1, 1, 1])


def test_a_metal_is_glossy_only():
    diffuse, glossy = principled_lobes((0.9, 0.5, 0.1), 1.0, 0.5, 1.5, 0.5)
    assert diffuse.reflectance == (0, 0, 0)
    assert albedo_of(glossy) == pytest.approx((0.9, 0.5, 0.1))


def test_without_specular_it_is_diffuse_only():
    diffuse, glossy = principled_lobes((0.9, 0.5, 0.1), 0.0, 0.5, 1.5, 0.0)
    assert diffuse.reflectance == pytest.approx((0.9, 0.5, 0.1))
    assert albedo_of(glossy) == (0, 0, 0)


@pytest.mark.parametrize("n", [1.1, 1.33, 1.5, 2.0, 4.0])
def test_average_fresnel_is_walshs_closed_form(n):
    """Walsh 1926, as in Duntley 1942: the reflectance of a smooth surface under even light, 0.0918 for glass of 1.5."""
    b = (n * n - 1) ** 2 / (n * n + 1) ** 3 * n * n * np.log((n - 1) / (n + 1))
    c = 2 * n**3 * (n * n + 2 * n - 1) / ((n * n + 1) * (n**4 - 1))
    d = 8 * n**4 * (n**4 + 1) / ((n * n + 1) * (n**4 - 1) ** 2) * np.log(n)
    walsh = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) ** 2) + b - c + d
    assert average_fresnel(n) == pytest.approx(walsh, abs=1e-5)
    assert average_fresnel(1.0) == 0


def test_specular_level_scales_the_reflection_at_normal_incidence():
    assert effective_ior(1.5, 0.5) == pytest.approx(1.5)
    f0 = lambda ior: ((ior - 1) / (ior + 1)) ** 2  # noqa: E731
    assert f0(effective_ior(1.5, 1.0)) == pytest.approx(0.08)
    assert effective_ior(1.5, 0.0) == 1
