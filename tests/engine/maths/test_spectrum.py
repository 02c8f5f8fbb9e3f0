"""Wavelengths and what they weigh in three channels (catalogue D15, D16)."""

import numpy as np
import pytest

from glanz.engine import Dielectric, SceneError
from glanz.engine.maths import spectrum
from glanz.engine.maths.spectrum import CHANNELS, LINE_C, LINE_D, LINE_F, place, sample_wavelength
from glanz.tests import chance, helpers as h

BK7 = Dielectric(1.5168, abbe=64.167)


def index(lobe, wavelength):
    return lobe.ior + lobe.spread * place(np.float64(wavelength))


def sellmeier_bk7(wavelength):
    """Schott's coefficients of N-BK7."""
    x = (wavelength / 1000) ** 2
    terms = ((1.03961212, 0.00600069867), (0.231792344, 0.0200179144), (1.01046945, 103.560653))
    return np.sqrt(1 + sum(b * x / (x - c) for b, c in terms))


def white_is_white():
    return (spectrum._PROBABILITY * spectrum._WEIGHT.astype(np.float64)).sum(axis=1) == pytest.approx(1, abs=1e-7)


def test_the_weights_of_every_channel_have_the_mean_one():
    """D16: exactly, for the probabilities with which wavelengths are chosen."""
    assert white_is_white()


def test_the_mean_catches_weights_of_another_distribution(monkeypatch):
    monkeypatch.setattr(spectrum, "_PROBABILITY", np.full(60, 1 / 60))
    assert not white_is_white()


@chance.fresh
def test_wavelengths_come_as_often_as_they_weigh():
    """B2: each of the sixty bins, and evenly within them; weights are never negative and add up to 3."""
    wavelength, weight = sample_wavelength(h.uniform(5, 200_000)[0])
    assert weight.min() >= 0
    assert weight.sum(axis=0) == pytest.approx(3, rel=1e-3)
    counts, _ = np.histogram(wavelength, 60, (400, 700))
    assert h.chi2_p(counts, spectrum._PROBABILITY * wavelength.size) > h.ALPHA
    assert h.mean_is((wavelength / 5) % 1, 0.5)
    for u in (0.0, 1 - 2.0**-24):
        at_end, _ = sample_wavelength(np.float32([u]))
        assert 400 <= at_end[0] <= 700


def test_channels_see_the_colours_that_they_are_named_after():
    """At 450 nm blue alone, at 540 green alone, at 620 red alone; between red and green lies yellow."""
    cdf = spectrum._CDF
    for wavelength, expected in ((452, (0, 0, 3)), (542, (0, 3, 0)), (622, (3, 0, 0))):
        u = cdf[int((wavelength - 400) / 5)] - 0.5 * spectrum._PROBABILITY[int((wavelength - 400) / 5)]
        assert sample_wavelength(np.array([u]))[1][:, 0] == pytest.approx(expected, abs=0.3)
    yellow = spectrum._WEIGHT[:, int((575 - 400) / 5)]
    assert min(yellow[:2]) > 0.8
    assert yellow[2] == 0


@pytest.mark.parametrize("lobe", [BK7, Dielectric(2.4, abbe=20.0), Dielectric(1 / 1.5, abbe=30.0)], ids=str)
def test_the_index_goes_through_what_is_given(lobe):
    """n_d at the line d, (n_d - 1) / (n_F - n_C) = V; and Cauchy's n = A + B / wavelength^2 in between."""
    assert index(lobe, LINE_D) == pytest.approx(lobe.ior, rel=1e-15)
    assert (lobe.ior - 1) / (index(lobe, LINE_F) - index(lobe, LINE_C)) == pytest.approx(lobe.abbe, rel=1e-12)
    wavelengths = np.linspace(400, 700, 50)
    a = np.polynomial.Polynomial.fit(wavelengths**-2, index(lobe, wavelengths), 1)
    assert a(wavelengths**-2) == pytest.approx(index(lobe, wavelengths), rel=1e-12)


def test_crown_glass_is_met_to_three_in_ten_thousand():
    """D15: BK7 by Sellmeier's formula has n_F 1.522376, n_d 1.516800, n_C 1.514322, V 64.167. Two numbers do not say more:
    Cauchy's curve through n_d and V is right to 6e-5 at the lines, and to 3e-4 between 400 and 700 nm."""
    for line, expected in ((LINE_F, 1.522376), (LINE_D, 1.516800), (LINE_C, 1.514322)):
        assert sellmeier_bk7(line) == pytest.approx(expected, abs=1e-6)
        assert index(BK7, line) == pytest.approx(expected, abs=6e-5)
    wavelengths = np.linspace(400, 700, 301)
    assert np.abs(index(BK7, wavelengths) - sellmeier_bk7(wavelengths)).max() <= 3e-4


def test_a_prism_spreads_the_lines_by_as_much_as_crown_glass_does():
    """D15: 60 degrees, each line at its least deviation 2 asin(n / 2) - 60: .708972 degrees between F and C, to 1e-4."""
    deviation = [2 * np.degrees(np.arcsin(index(BK7, line) / 2)) for line in (LINE_F, LINE_C)]
    assert deviation[0] - deviation[1] == pytest.approx(0.708972, abs=1e-4)


def test_each_channel_has_its_mean_index():
    for c, wavelength in enumerate(CHANNELS[:, 0]):
        mean = (spectrum._SHARES[c] * index(BK7, spectrum._MIDDLES)).sum()
        assert index(BK7, wavelength) == pytest.approx(mean, abs=1e-7)


@pytest.mark.parametrize("abbe", [0.0, 0.9, -20.0, float("nan")])
def test_senseless_abbe_numbers_are_refused_by_name(abbe):
    with pytest.raises(SceneError, match=r"material 'Pane'.*Abbe number is"):
        Dielectric(1.5, abbe=abbe).check("Pane")


def test_indices_that_would_fall_below_nothing_are_refused():
    with pytest.raises(SceneError, match=r"material 'Pane'.*between 400 and 700 nm"):
        Dielectric(0.3, abbe=1.0).check("Pane")
    Dielectric(3.0, abbe=1.0).check("Pane")
