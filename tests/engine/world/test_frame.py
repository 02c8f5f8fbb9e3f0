"""Render space: moved to the camera, scaled by a power of two, before float32 is seen."""

import math

import numpy as np
import pytest

from glanz.engine.world.frame import Frame


@pytest.mark.parametrize("median", [1e-300, 1e-16, 0.3, 0.5, 1.0, 7.0, 1e16, 1e300])
def test_the_median_distance_falls_just_below_one(median):
    frame = Frame.around((0, 0, 0), np.array([median, median, median, 1e5, np.inf, np.nan, 0.0]))
    assert math.frexp(frame.scale)[0] == 0.5  # a power of two
    if 1e-17 < median < 1e17:
        assert 0.5 <= median * frame.scale < 1


def test_a_scene_without_distances_keeps_its_scale():
    for distances in ([], [0.0], [np.nan, np.inf]):
        scale = Frame.around((1, 2, 3), np.array(distances)).scale
        assert scale in (0.5, 1.0)


def test_points_keep_the_digits_that_the_world_does_not_show():
    """A nanometre at a distance of 1e7 m survives, because the camera is subtracted in float64."""
    frame = Frame(np.array([1e7, 0, 0]), 2.0)
    assert frame.points(np.array([[1e7 + 2.0**-29], [0], [0]]))[0, 0] == 2.0**-28
