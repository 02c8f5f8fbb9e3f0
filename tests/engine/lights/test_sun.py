"""The sun against closed forms (catalogue E3)."""

import math

import numpy as np
import pytest

from glanz.engine import SceneError, SunLight
from glanz.engine.maths.vectors import dot
from glanz.tests import helpers as h


def sampled(sun, n=200):
    k = h.table(sun.row(h.UNIT_FRAME))
    u2 = h.stratified(1, n)
    return k, sun.sample(k, np.zeros((3, n * n)), u2)


@pytest.mark.parametrize("angle", [0.0, 1e-4, math.radians(0.533), 1.0, math.pi])
def test_a_sun_gives_its_irradiance_to_what_faces_it(angle):
    """E3, and E cos for what is tilted while all of the disk is above the horizon; to 1e-3 of sampling, exact for a direction."""
    sun = SunLight(towards=tuple(h.at_angle(0.3, 1.0).ravel()), irradiance=(3.0, 2.0, 1.0), angle=angle)
    _, (wi, distance, E, _) = sampled(sun)
    assert np.isposinf(distance).all()
    for normal, cos in ((h.at_angle(0.3, 1.0), 1.0), (h.at_angle(0.0), math.cos(0.3))):
        if angle < math.pi / 2 or cos == 1:
            mean = (E * np.maximum(dot(normal, wi), 0)).mean(axis=1)
            np.testing.assert_allclose(mean, cos * np.array((3, 2, 1)), rtol=1e-12 if angle == 0 else 1e-3)


@pytest.mark.parametrize("angle", [1e-4, math.radians(0.533), 1.0, math.pi])
def test_samples_fill_the_disk_of_the_sun(angle):
    """cos to the middle is uniform: its mean is half way to the edge, and no sample lies outside."""
    sun = SunLight(towards=tuple(h.at_angle(0.3, 1.0).ravel()), angle=angle)
    _, (wi, _, _, pdf) = sampled(sun)
    q = 0.5 * ((wi - h.at_angle(0.3, 1.0)) ** 2).sum(axis=0)
    edge = 2 * math.sin(angle / 4) ** 2
    assert q.max() <= edge * (1 + 1e-9)
    assert q.mean() == pytest.approx(edge / 2, rel=1e-3)
    np.testing.assert_allclose(pdf, 1 / (2 * math.pi * edge), rtol=1e-12)


def test_the_disk_of_the_sun_has_the_radiance_of_its_irradiance():
    """E / (pi sin^2 a): what a ray into the sun sees."""
    sun = SunLight(irradiance=(3.0, 2.0, 1.0), angle=0.02)
    k = h.table(sun.row(h.UNIT_FRAME))
    t, L, _ = sun.hit(k, np.zeros((3, 2)), np.concatenate((h.at_angle(0.0099), h.at_angle(0.0101)), axis=1))
    assert np.isfinite(t).tolist() == [True, False]
    np.testing.assert_allclose(L[:, 0], np.array((3, 2, 1)) / (math.pi * math.sin(0.01) ** 2), rtol=1e-12)


def test_a_bad_sun_is_refused_by_name():
    for angle in (-0.1, 3.2):
        with pytest.raises(SceneError, match=f"light 'Sol': angle is {angle} rad"):
            SunLight(name="Sol", angle=angle).check()
