"""Daylight as the physics of its models has it, against integrals done another way."""

import numpy as np
import pytest
from scipy.integrate import quad

from glanz.engine.maths import atmosphere, scattering
from glanz.engine.maths.daylight import preetham
from glanz.engine.maths.observer import FROM_XYZ
from glanz.engine.maths.skydome import hosek_wilkie

LOOK = np.radians([3.0, 20.0, 80.0]), np.radians([0.0, 60.0, 170.0])
MODELS = {"single": scattering.single_scattering, "multiple": atmosphere.multiple_scattering}


def along(height, cosine, r0):
    """Height above the ground [km] at a distance t from a height, at a cosine from the zenith."""
    r = r0 + height
    return lambda t: np.sqrt(r * r + 2 * r * cosine * t + t * t) - r0


@pytest.mark.parametrize("elevation", [0.05, 0.3, 1.4])
def test_the_depth_of_air_and_haze_is_their_integral(elevation):
    """Towards the horizon eight nodes are as good as what Blender does, which is 1 % of the haze."""
    d = np.array([np.cos(elevation), 0.0, np.sin(elevation)])[:, None]
    height = along(0.1, np.sin(elevation), scattering.EARTH)
    depth = scattering._optical_depth(np.array([0.0, 0.0, scattering.EARTH + 0.1])[:, None], d)[:, 0]
    for k, thickness in enumerate((8.0, 1.2)):
        expected = quad(lambda t, h=thickness: np.exp(-height(t) / h), 0, 900, limit=500, epsrel=1e-10)[0]
        assert depth[k] == pytest.approx(expected, rel=0.02)


def test_light_from_the_zenith_is_weakened_by_the_integral_of_what_is_in_its_way():
    through = atmosphere._transmittance(np.zeros(1), np.ones(1), (1.0, 1.0, 1.0))[:, 0]
    for k in range(4):
        depth = quad(lambda h, k=k: atmosphere._coefficients(np.array([h]), (1.0, 1.0, 1.0))[2][k, 0], 0, 100, limit=500)[0]
        assert through[k] == pytest.approx(np.exp(-depth), rel=0.01)


@pytest.mark.parametrize("radiance", MODELS.values(), ids=MODELS)
def test_nothing_scatters_where_there_is_neither_air_nor_haze(radiance):
    assert not radiance(*LOOK, 0.5, 0.1, 0.0, 0.0, 1.0).any()


@pytest.mark.parametrize("radiance", MODELS.values(), ids=MODELS)
def test_thin_air_scatters_in_proportion_to_its_density(radiance):
    one, two = (radiance(*LOOK, 0.5, 0.1, density, 0.0, 0.0) for density in (0.5**10, 0.5**9))
    np.testing.assert_allclose(two / one, 2, rtol=0.01)


def test_what_is_scattered_once_by_thin_air_is_its_phase_function_times_its_depth():
    """L = E beta phase(cos) depth, in the spectrum's colours; compared between two angles, the spectrum drops out."""
    thin = 0.5**14
    L = scattering.single_scattering([0.5 * np.pi], [0.0], 1.0, 0.001, thin, 0.0, 0.0)[:, 0, 0]
    across = scattering.single_scattering([0.5 * np.pi], [0.0], 0.5 * np.pi, 0.001, thin, 0.0, 0.0)[:, 0, 0]
    np.testing.assert_allclose(L / across, (1 + np.sin(1.0) ** 2) / 2, rtol=1e-3)


@pytest.mark.parametrize("disk", [scattering.sun_disk, lambda *a: atmosphere.sun_disk(*a, 1.0)], ids=MODELS)
def test_a_sun_of_any_size_gives_the_same_light(disk):
    small, large = (np.mean(disk(0.5 * np.pi, size, 0.1, 1.0, 1.0), axis=0) * size**2 for size in (0.001, 0.02))
    np.testing.assert_allclose(small, large, rtol=1e-3)


def test_blue_above_and_red_where_the_sun_sets():
    for radiance in MODELS.values():
        noon = radiance([1.0], [3.0], 1.0, 0.1, 1.0, 1.0, 1.0)[:, 0, 0]
        assert noon[2] > noon[0]
    lower, upper = scattering.sun_disk(0.1, 0.01, 0.1, 1.0, 1.0)
    assert upper[0] > 2 * upper[2] > 0
    assert (lower < upper).all()


@pytest.mark.parametrize("turbidity", [2.0, 6.0])
def test_the_zenith_is_as_bright_as_preetham_says(turbidity):
    """(Y_z = (4.0453 T - 4.9710) tan chi - 0.2155 T + 2.4192, in Blender's unit.)"""
    sun = 0.7
    L = preetham(np.array([[0.0], [0.0], [1.0]], np.float32), (np.sin(sun), 0.0, np.cos(sun)), turbidity)[:, 0]
    chi = (4 / 9 - turbidity / 120) * (np.pi - 2 * sun)
    expected = 0.06 * ((4.0453 * turbidity - 4.9710) * np.tan(chi) - 0.2155 * turbidity + 2.4192)
    assert np.dot((0.2126729, 0.7151522, 0.0721750), L) == pytest.approx(expected, rel=1e-4)


# Of the published data set: Z under a sun in the zenith, over a white ground, at the turbidity of 10: A B C D E F G I H, and the mean.
PUBLISHED = (-0.9863181, -0.1803364, 0.5810824, 4.580570, -3.863454, 0.5328174, 0.2272821, 1.771114, 0.6791814, 31.10255)


@pytest.mark.parametrize("theta", [0.0, 0.6, 1.4])
def test_the_sky_of_hosek_and_wilkie_is_their_formula_with_their_numbers(theta):
    L = hosek_wilkie(np.array([[np.sin(theta)], [0.0], [np.cos(theta)]], np.float32), (0.0, 0.0, 1.0), 10.0, 1.0)[:, 0]
    A, B, C, D, E, F, G, I, H, mean = PUBLISHED  # noqa: E741
    c = np.cos(theta)
    chi = (1 + c * c) / (1 + H * H - 2 * H * c) ** 1.5
    expected = (1 + A * np.exp(B / (c + 0.01))) * (C + D * np.exp(E * theta) + F * c * c + G * chi + I * np.sqrt(c)) * mean
    assert np.linalg.solve(FROM_XYZ, L)[2] == pytest.approx(2 * np.pi / 683 * expected, rel=1e-4)


def test_the_sky_of_hosek_and_wilkie_changes_evenly_with_haze_and_ground():
    """Coefficients are linear between data, so that half a step is close to the mean of its ends; where data meet nothing jumps."""

    def seen(turbidity, albedo):
        return hosek_wilkie(np.array([[0.6], [0.0], [0.8]], np.float32), (0.0, 0.6, 0.8), turbidity, albedo)

    for (a, b), middle in ((((3.0, 0.2), (3.2, 0.2)), (3.1, 0.2)), (((5.0, 0.4), (5.0, 0.6)), (5.0, 0.5))):
        low, high = seen(*a), seen(*b)
        np.testing.assert_allclose(seen(*middle), (low + high) / 2, rtol=1e-3)
        assert (np.abs(low / high - 1) > 5e-3).all()
    for turbidity in range(2, 10):
        np.testing.assert_allclose(seen(turbidity - 1e-4, 0.3), seen(turbidity + 1e-4, 0.3), rtol=1e-3)
