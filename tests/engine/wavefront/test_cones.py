"""What rays stand for, see `wavefront.cones`."""

from types import SimpleNamespace

import numpy as np

from glanz.engine.arrays import Columns
from glanz.engine.wavefront import cones
from glanz.engine.world.texturing import footprints
from glanz.tests import helpers as h


def test_rays_scattered_by_chance_are_here_and_there_ever_after():
    """A mirror keeps rays beside each other, but it brings none back that are not."""
    carried = Columns(width=np.zeros(3), spread=np.zeros(3), extent=np.ones(3), is_even=np.array([True, True, False]))
    scattered = SimpleNamespace(carried=carried, pdf=np.float32([np.inf, 3, np.inf]))
    cones.leave_with_cones(None, None, None, None, scattered)
    assert carried.is_even.tolist() == [True, False, False]
    assert carried.width.tolist() == [1, 1, 1]


def test_a_cone_cuts_an_ellipse_out_of_a_triangle():
    """As wide as the cone across, longer by 1 / cos along its direction; as from above where rays are here and there."""
    n, width = 200, np.float32(0.3)
    rng = np.random.default_rng(1)
    e1, e2 = (rng.standard_normal((3, n)).astype(np.float32) for _ in range(2))
    wo = rng.standard_normal((3, n)).astype(np.float32)
    wo /= np.sqrt((wo * wo).sum(axis=0))
    normal = np.cross(e1.T, e2.T).T
    normal /= np.sqrt((normal * normal).sum(axis=0))
    cos = np.abs((normal * wo).sum(axis=0))
    usual = cos > 0.05
    for is_stretched in (True, False):
        axes = footprints(e1, e2, wo, np.full(n, width), np.full(n, is_stretched))
        long, short = (a * e1 + b * e2 for a, b in axes)
        lengths = np.sqrt((long * long).sum(axis=0)), np.sqrt((short * short).sum(axis=0))
        expected = 0.5 * width / np.where(is_stretched, cos, 1)
        np.testing.assert_allclose(lengths[0][usual], expected[usual], rtol=2e-3)
        np.testing.assert_allclose(lengths[1][usual], 0.5 * width, rtol=2e-3)
        assert np.abs((long * short).sum(axis=0) / (lengths[0] * lengths[1]))[usual].max() <= 2e-3
        # Along the view as it lies in the triangle.
        assert np.abs(np.cross(long.T, (wo - (normal * wo).sum(axis=0) * normal).T))[usual].max() <= 0.02


def test_seen_from_above_a_footprint_is_a_circle():
    e1, e2, wo = (np.float32(a)[:, None] for a in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
    first, second = footprints(e1, e2, wo, np.float32([2.0]), np.array([True]))
    assert h.same_bits(np.abs(np.concatenate((first, second), axis=1)), np.eye(2, dtype=np.float32))
