"""Choosing texels, and places around them (catalogue B2, B9)."""

import numpy as np
import pytest

from glanz.engine.maths import discrete, interpolation
from glanz.engine.maths.texels import Texels
from glanz.tests import chance, helpers as h

RANDOM = np.random.default_rng(1)
PICTURES = {
    "one": np.ones((1, 1)),
    "row": RANDOM.random((1, 7)),
    "column": RANDOM.random((5, 1)),
    "odd": RANDOM.random((9, 17)) ** 3,
    "power of two": RANDOM.random((8, 16)),
    "holes": RANDOM.random((6, 10)) * (RANDOM.random((6, 10)) > 0.5),
    "dark rows and columns": np.outer([0, 0, 1, 2, 0], [0, 3, 0, 1, 0]),
    "hot": np.where(np.arange(60).reshape(6, 10) == 23, 1e30, 1.0),
}
N = 200_000


def texels(weights):
    return Texels.of((part for part in np.array_split(weights.astype(float), 2) if len(part)), weights.shape)


def told(weights):
    return texels(weights).shares.reshape(weights.shape).astype(float)


def check_choice(name):
    weights = PICTURES[name].astype(float)
    row, column, u2 = texels(weights).choose(h.uniform(2, N, np.float32))
    counts = np.zeros(weights.shape)
    np.add.at(counts, (row, column), 1)
    assert (counts[weights == 0] == 0).all()
    # What weighs next to nothing is chosen with the least probability that there is, by design.
    share = weights / weights.sum()
    assert h.chi2_p(counts, N * np.where(share > 1e-4, share, told(weights))) > h.ALPHA
    assert u2.min() >= 0
    assert u2.max() < 1
    # What is left of the numbers is uniform again.
    assert h.chi2_p(np.histogram2d(*u2, bins=8, range=((0, 1), (0, 1)))[0], np.full((8, 8), N / 64)) > h.ALPHA


@pytest.mark.parametrize("name", PICTURES)
@chance.fresh
def test_texels_come_in_proportion(name):
    """chi2 of 2e5 choices; detects 3 % of a texel with a tenth of all."""
    check_choice(name)


def test_proportion_catches_the_distribution_of_another_row(monkeypatch):
    choose = Texels.choose

    def wrong(self, u2):
        return choose(h.replaced(self, columns=np.roll(self.columns, 1, axis=0)), u2)

    monkeypatch.setattr(Texels, "choose", wrong)
    with pytest.raises(AssertionError):
        check_choice("odd")


@pytest.mark.parametrize("name", PICTURES)
def test_probabilities_are_those_of_the_distributions(name):
    """They sum to 1, are 0 only where nothing is, and agree with `discrete`, which tells its choices exactly."""
    weights = PICTURES[name].astype(float)
    p = told(weights)
    assert p.sum() == pytest.approx(1, abs=1e-6)
    assert ((p > 0) == (weights > 0)).all()
    rows = discrete.probabilities(discrete.cumulative(weights.sum(axis=1)))
    np.testing.assert_allclose(p.sum(axis=1), rows, rtol=1e-6)


def check_places(texel, place, look):
    """Places around one texel of a picture of 4 x 5 have the density that looking there gives its weight."""
    shape, bins = (4, 5), 4
    n = 100_000
    u, v = place(*(np.full(n, i) for i in texel), h.uniform(3, n, np.float32), shape)
    assert min(u.min(), v.min()) >= 0
    assert max(u.max(), v.max()) <= 1
    observed = np.histogram2d(v, u, (bins * shape[0], bins * shape[1]), ((0, 1), (0, 1)))[0]
    fine = 8 * bins
    v, u = ((np.arange(fine * m) + 0.5) / (fine * m) for m in shape)
    v, u = (x.ravel().astype(np.float32) for x in np.meshgrid(v, u, indexing="ij"))
    weight = sum(w * ((row == texel[0]) & (column == texel[1])) for row, column, w in look(u, v, shape))
    expected = weight.reshape(bins * shape[0], 8, bins * shape[1], 8).sum(axis=(1, 3))
    assert h.chi2_p(observed, n * expected / expected.sum()) > h.ALPHA
    # Every texel has the same share of the picture, or weights would not stand for light.
    assert expected.sum() == pytest.approx(fine * fine, rel=1e-3)


@pytest.mark.parametrize("texel", [(0, 0), (0, 4), (1, 2), (3, 0), (3, 3)], ids=str)
@pytest.mark.parametrize("way", ["linear", "nearest"])
def test_places_have_the_density_of_their_weight(way, texel):
    """In the first and last row too, and across the seam; detects 3 % in a quarter of the bins."""
    check_places(texel, getattr(interpolation, f"{way}_place"), getattr(interpolation, f"{way}_texels"))


@pytest.mark.parametrize(("way", "other"), [("linear", "nearest"), ("nearest", "linear")])
def test_density_catches_a_place_that_does_not_belong_to_its_weight(way, other):
    with pytest.raises(AssertionError):
        check_places((1, 2), getattr(interpolation, f"{way}_place"), getattr(interpolation, f"{other}_texels"))


@pytest.mark.parametrize("way", ["linear", "nearest"])
def test_weights_of_a_place_sum_to_one(way):
    u, v = h.uniform(4, 10_000, np.float32)
    u[:3], v[:3] = (0, 1, 0.5), (0, 1, 1)
    for shape in ((1, 1), (1, 2), (3, 1), (4, 5)):
        found = getattr(interpolation, f"{way}_texels")(u, v, shape)
        np.testing.assert_allclose(sum(weight for _, _, weight in found), 1, rtol=1e-6)
        for row, column, _ in found:
            assert 0 <= row.min() <= row.max() < shape[0]
            assert 0 <= column.min() <= column.max() < shape[1]
