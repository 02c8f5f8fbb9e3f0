"""Projections of pictures against their geometry: places around spheres and tubes, sides of boxes."""

import numpy as np
import pytest

from glanz.engine.maths import projections
from glanz.engine.maths.projections import PROJECTIONS, sides_of_box


def points(seed=1, n=1000):
    return np.random.default_rng(seed).random((3, n)).astype(np.float32)


def test_a_sphere_is_unrolled_by_longitude_and_latitude():
    """The point that lies at angles (turn, height) about the middle of the unit cube is at those shares of the picture."""
    u, v = points()[:2] * 0.98 + 0.01
    angle = np.pi * (1 - 2 * u)
    p = 0.5 + 0.3 * np.stack((np.sin(np.pi * v) * np.sin(angle), np.sin(np.pi * v) * np.cos(angle), -np.cos(np.pi * v)))
    x, y, axes = PROJECTIONS["sphere"](p.astype(np.float32), None)
    assert axes is None
    np.testing.assert_allclose((x, y), (u, v), atol=2e-6)


def test_a_tube_is_unrolled_by_longitude_and_height():
    u, v = points()[:2] * 0.98 + 0.01
    angle = np.pi * (1 - 2 * u)
    x, y, _ = PROJECTIONS["tube"](np.float32((0.5 + 0.3 * np.sin(angle), 0.5 + 0.3 * np.cos(angle), v)), None)
    np.testing.assert_allclose((x, y), (u, v), atol=2e-6)


@pytest.mark.parametrize("name", ["flat", "sphere", "tube"])
def test_footprints_are_how_far_places_move(name):
    p, step = points(), 1e-3 * points(2)
    x, y, (first, second) = PROJECTIONS[name](p, (step, -step))
    moved = PROJECTIONS[name](p + step, None)
    turn = moved[0] - x
    np.testing.assert_allclose(first, (turn - np.round(turn), moved[1] - y), atol=2e-6)
    # Also across the seam, where places jump by a whole turn.
    assert np.abs(second[0]).max() < 0.5


def test_the_axis_of_a_sphere_or_tube_is_somewhere():
    for name in ("sphere", "tube"):
        p = np.float32([[0.5, 0.5], [0.5, 0.5], [0.5, 0.9]])
        assert np.isfinite(PROJECTIONS[name](p, (p, p))[:2]).all()


def sides(normal, blend):
    p = points(n=normal.shape[1])
    return p, [*sides_of_box(p, None, normal.astype(np.float32), blend)]


@pytest.mark.parametrize("blend", [0.0, 0.2, 0.7, 1.0])
def test_the_sides_of_a_box_share_each_point(blend):
    """Weights are in [0, 1] and add up to 1; what a normal points along is all of that side's."""
    normal = np.random.default_rng(3).standard_normal((3, 5000))
    weights = np.array([weight for weight, *_ in sides(normal, blend)[1]])
    assert weights.min() >= 0 and weights.max() <= 1 + 1e-6
    np.testing.assert_allclose(weights.sum(axis=0), 1, atol=1e-5)
    for axis in range(3):
        along = np.zeros((3, 1))
        along[axis] = -2
        assert [weight.item() for weight, *_ in sides(along, blend)[1]] == [float(i == axis) for i in range(3)]
    is_whole = (weights.max(axis=0) == 1).mean()
    assert is_whole == 1 if not blend else is_whole < 1


def test_weights_of_a_box_have_no_step_where_it_blends():
    turn = np.linspace(0, np.pi / 2, 2000)
    for normal in (np.stack((np.cos(turn), np.sin(turn), 0 * turn)), np.stack((np.cos(turn), np.sin(turn), 0.7 + 0 * turn))):
        weights = np.array([weight for weight, *_ in sides(normal, 0.5)[1]])
        assert np.abs(np.diff(weights, axis=1)).max() <= 0.01


def test_steps_catch_a_limit_that_is_another(monkeypatch):
    weights = projections._weights_of_box
    monkeypatch.setattr(projections, "_weights_of_box", lambda n, blend: weights(n, np.float32(0.0)))
    with pytest.raises(AssertionError):
        test_weights_of_a_box_have_no_step_where_it_blends()


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [-1, 1])
def test_pictures_stand_upright_and_unmirrored_on_sides_seen_from_outside(axis, sign):
    """Picture axes x, y and the normal are right-handed, but for the lower and upper side, which are one picture seen through."""
    normal = np.zeros((3, 1), np.float32)
    normal[axis] = sign
    steps = np.eye(3, dtype=np.float32)
    p = np.full((3, 1), 0.5, np.float32)
    found = [[*sides_of_box(p + 0.1 * step[:, None], None, normal, 0.0)][axis] for step in steps]
    x, y = (np.array([(side[i] - 0.5).item() / 0.1 for side in found]) for i in (1, 2))
    assert np.dot(np.cross(x, y), normal[:, 0]) == pytest.approx(1)
    assert y[2] == pytest.approx(0 if axis == 2 else 1)
