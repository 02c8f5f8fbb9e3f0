"""A pixel is the area that is covered of it (catalogue G9): triangles under the box filter against polygons that were cut."""

import numpy as np
import pytest

from glanz.engine import OrthographicCamera
from glanz.engine.wavefront import camera_rays
from glanz.tests import chance, helpers as h

SIDE = 8
CORNERS = np.array(((-3.1, -2.7), (3.3, -1.9), (0.7, 3.6))).T
"""Of a white triangle (2, 3) [px] from the middle of the frame, y up: it touches 32 of 64 pixels and covers 9 of them."""


def scene():
    triangle = h.Mesh(name="white", vertices=np.append(CORNERS, [[0.0] * 3], axis=0), triangles=np.array([[0, 1, 2]]).T)
    camera = OrthographicCamera.look_at((0, 0, 1), (0, 0, 0), up=(0, 1, 0), height=SIDE)
    return h.scene([h.thing(triangle, h.lambert(0, "light", 1.0))], camera=camera)


def area(polygon):
    """Of a polygon, a list of corners, by the shoelace formula."""
    x, y = np.array(polygon).T if polygon else np.zeros((2, 1))
    return 0.5 * abs((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def cut(polygon, axis, at, sign):
    """The part of a polygon with sign (corner[axis] - at) >= 0 (Sutherland and Hodgman 1974)."""
    result = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        da, db = sign * (a[axis] - at), sign * (b[axis] - at)
        if da >= 0:
            result.append(a)
        if (da >= 0) != (db >= 0):
            result.append(a + (b - a) * (da / (da - db)))
    return result


def covered():
    """(SIDE, SIDE) shares of the pixels."""
    result = np.zeros((SIDE, SIDE))
    for row, column in np.ndindex(SIDE, SIDE):
        part = list(CORNERS.T)
        left, bottom = column - SIDE / 2, SIDE / 2 - row - 1
        for axis, low in ((0, left), (1, bottom)):
            part = cut(cut(part, axis, low, 1), axis, low + 1, -1)
        result[row, column] = area(part)
    return result


def pictures(samples, seeds, sampler="stratified"):
    settings = h.settings(width=SIDE, height=SIDE, samples=samples, sampler=sampler)
    return np.array([h.pixels(scene(), h.replaced(settings, seed=seed))[0] for seed in range(seeds)], np.float64)


def check_coverage():
    """The mean of each pixel at level ALPHA, exact where all or nothing is covered; detects a shift of 0.01 px."""
    truth = covered()
    assert truth.sum() == pytest.approx(area(list(CORNERS.T)), rel=1e-12)
    images = pictures(256, 60)
    partly = np.abs(truth - truth.round()) > 1e-9
    assert (images[:, ~partly] == truth[~partly].round()).all()
    for row, column in np.argwhere(partly):
        assert h.mean_is(images[:, row, column], truth[row, column], absolute=1e-9), (row, column)
    # Together they see what none sees alone.
    error = images[:, partly].mean(axis=0) - truth[partly]
    chi2 = ((error / (images[:, partly].std(axis=0, ddof=1) / np.sqrt(60))) ** 2).sum()
    assert chi2 < 100


@chance.fresh
def test_a_pixel_is_the_area_that_is_covered():
    check_coverage()


@pytest.mark.parametrize("stretch", [(1.0, 0.01), (1.01, 0.0)], ids=["shifted", "wider"])
def test_coverage_catches_a_frame_that_is_a_hundredth_off(stretch, monkeypatch):
    aim = camera_rays.through_the_pinhole
    scale, shift = (np.float32(v) for v in stretch)
    monkeypatch.setattr("glanz.engine.plan.through_the_pinhole", lambda plan, rays, x, y: aim(plan, rays, x * scale + shift, y))
    with pytest.raises(AssertionError):
        check_coverage()


@pytest.mark.parametrize(("sampler", "expected"), [("random", -0.5), ("stratified", -0.75)])
def test_the_error_of_coverage_falls_as_theory_says(sampler, expected):
    """G9, H1 in a picture: slope of the RMSE of pixels that an edge goes through; within 0.07."""
    truth = covered()
    partly = (truth > 0.02) & (truth < 0.98)
    counts = np.array((4, 16, 64, 256))
    errors = [np.sqrt(np.mean(np.square(pictures(int(n), 40, sampler) - truth)[:, partly])) for n in counts]
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(expected, abs=0.07)
