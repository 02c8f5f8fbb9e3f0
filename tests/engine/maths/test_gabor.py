"""Gabor noise is that of a scalar twin in float64 (Lagae et al. 2009, equations 6 and 8)."""

import itertools
import math

import numpy as np
import pytest

from glanz.engine.maths import gabor
from glanz.engine.maths.gabor import SPREADS, phasor
from glanz.tests import helpers as h
from glanz.tests.engine.maths.test_cellhash import twin_unit
from glanz.tests.engine.maths.test_perlin import places


def twin_phasor(p, frequency, isotropy, orientation):
    cell = [math.floor(c) for c in p]
    total = 0j
    for step in itertools.product((-1, 0, 1), repeat=len(p)):
        where = [c + s for c, s in zip(cell, step)]
        for i in range(8):
            turn, place, sign = 3.0 * i, 3.0 * i + 1, 3.0 * i + 2
            if len(p) == 2:
                x, y = where
                centre = twin_unit(x, y, place), twin_unit(place, x, y)
                angle = orientation + (twin_unit(x, y, turn) - 0.5) * math.pi * isotropy
                direction = math.cos(angle), math.sin(angle)
            else:
                x, y, z = where
                centre = twin_unit(x, y, z, place), twin_unit(z, x, place, y), twin_unit(place, z, y, x)
                theta = math.acos(orientation[2]) + twin_unit(x, y, z, turn) * math.pi * isotropy
                phi = math.atan2(orientation[1], orientation[0]) + twin_unit(z, x, turn, y) * math.pi * isotropy
                direction = math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)
            d = [c - w - o for c, w, o in zip(p, where, centre)]
            square = sum(x * x for x in d)
            if square < 1:
                size = math.exp(-math.pi * square) * (0.5 + 0.5 * math.cos(math.pi * square))
                waves = sum(x * w for x, w in zip(d, direction))
                total += (-size if twin_unit(*where, sign) < 0.5 else size) * np.exp(2j * math.pi * frequency * waves)
    return total.real, total.imag


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("isotropy", [0.0, 0.4, 1.0])
def test_waves_are_those_of_the_twin(dimensions, isotropy):
    p = places(30, 8.0, dimensions)
    orientation = np.float32([0.7]) if dimensions == 2 else np.float32([[0.6], [-0.64], [0.48]])
    found = phasor(p, np.float32([1.7]), np.float32([isotropy]), orientation)
    towards = float(orientation[0]) if dimensions == 2 else orientation[:, 0].tolist()
    expected = [twin_phasor(list(map(float, q)), 1.7, isotropy, towards) for q in p.T]
    assert found.dtype == np.float32
    assert np.abs(found.T - expected).max() <= 1e-4


def test_the_twin_catches_impulses_of_one_sign(monkeypatch):
    unit = gabor.unit
    monkeypatch.setattr(gabor, "unit", lambda *seeds: np.float32(0.5) * unit(*seeds))
    with pytest.raises(AssertionError):
        test_waves_are_those_of_the_twin(2, 0.4)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_the_mean_is_0_and_the_spread_is_four_to_six_standard_deviations(dimensions):
    p = places(4000, 100.0, dimensions)
    orientation = np.float32([0.7]) if dimensions == 2 else np.float32([[0.6], [-0.64], [0.48]])
    sine = phasor(p, np.float32([3]), np.float32([1]), orientation)[1]
    assert abs(sine.mean()) <= h.Z * sine.std() / 4000**0.5
    assert 4 <= SPREADS[dimensions] / sine.std() <= 6
