"""Motion between keys: exact for constant velocity and constant spin, and what the tables say is what single matrices say."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from glanz.engine.maths.poses import Keys, between, quaternion, rotation_matrix
from glanz.engine.world.frame import Frame
from glanz.engine.world.poses import Path, Poses, is_constant
from glanz.tests import helpers as h
from glanz.tests.moving import turned

TIMES = (0.0, 0.1, 0.5, 0.77, 1.0)


def random_keys(seed, count, mirrored=False):
    rng = np.random.default_rng(seed)
    stretch = [rng.uniform(0.3, 3, 3) * (1, 1, -1 if mirrored else 1) for _ in range(count)]
    return np.stack([h.affine(h.rotation(seed + i) @ np.diag(s), rng.normal(size=3)) for i, s in enumerate(stretch)])


@pytest.mark.parametrize("seed", range(20))
def test_a_quaternion_is_its_rotation(seed):
    for turn in (h.rotation(seed), np.diag([1.0, -1.0, -1.0]), np.eye(3)):
        assert np.abs(rotation_matrix(quaternion(turn)) - turn).max() <= 1e-15 * 8


@pytest.mark.parametrize("mirrored", [False, True])
def test_keys_are_met_exactly(mirrored):
    keys = random_keys(3, 5, mirrored)
    path = Keys.of(keys)
    for i, key in enumerate(keys):
        np.testing.assert_allclose(path.matrix(i / 4), key, atol=1e-14)
    assert (np.linalg.det(np.moveaxis(path.stretch, -1, 0)) < 0).all() == mirrored
    assert np.abs(path.stretch - path.stretch.transpose(1, 0, 2)).max() <= 1e-14


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-6, 0.1, 1.5, 3.1])
def test_constant_spin_and_velocity_are_exact(angle):
    """Against the closed form, through the middle of the key and beside it."""
    path = Keys.of(turned((0.3, 0.3 + angle)))
    for time in TIMES:
        np.testing.assert_allclose(path.matrix(time), turned((0.3 + time * angle,))[0], atol=1e-15 * 8)


def test_rotations_between_keys_are_those_of_an_independent_slerp():
    turns = [h.rotation(i) for i in range(4)]
    slerp = Slerp(np.linspace(0, 1, 4), Rotation.from_matrix(turns))
    path = Keys.of(np.stack([h.affine(turn) for turn in turns]))
    for time in TIMES:
        np.testing.assert_allclose(path.matrix(time)[:3, :3], slerp(time).as_matrix(), atol=1e-14)


def test_a_flat_key_does_not_turn_things_over():
    """What flattens space leaves the direction of one axis open; the way there is the short one."""
    keys = np.stack([h.affine(np.diag([1.0, 1.0, 0.5])), h.affine(np.diag([1.0, 1.0, 0.0])), h.affine(np.diag([1.0, 1.0, 0.5]))])
    for time in TIMES:
        np.testing.assert_allclose(np.diag(Keys.of(keys).matrix(time))[:2], 1, atol=1e-14)


def test_one_axis_changes_sides_where_keys_differ_in_their_hand():
    keys = np.stack([h.affine(np.diag([2.0, 3.0, 1.0])), h.affine(np.diag([2.0, 3.0, -1.0]))])
    np.testing.assert_allclose(Keys.of(keys).matrix(0.5)[:3, :3], np.diag([2.0, 3.0, 0.0]), atol=1e-14)


def test_rigid_bodies_are_known_through_the_rounding_of_float32():
    start = h.affine(h.rotation(1) @ np.diag([1, 2, 3]))
    keys = np.stack([start, turned((0.7,))[0] @ start]).astype(np.float32).astype(np.float64)
    assert is_constant(Keys.of(keys).stretch)
    keys[1, :3, :3] *= 1.0001
    assert not is_constant(Keys.of(keys).stretch)


def test_the_table_of_many_is_each_of_them():
    """Paths of 2, 3 and 5 keys, stretched, mirrored and rigid, at random times: points, and the way back, to 1e-13."""
    frame = Frame(np.array([1.0, 2.0, 3.0]), 2.0)
    rng = np.random.default_rng(1)
    keys = [random_keys(10, 2), random_keys(20, 3, True), random_keys(30, 5), turned((0, 1.0, 2.0), (1, 0, 0))]
    locals_ = [Keys.of(k).stretch_at(0.5) for k in keys]
    anchors = rng.normal(size=(4, 3))
    poses = Poses.of([Path.of(Keys.of(k), local, a, frame) for k, local, a in zip(keys, locals_, anchors)])
    n = 400
    time, index, p = rng.random(n, np.float32), rng.integers(0, 4, n), rng.normal(size=(3, n))
    local = np.stack([frame.scale * locals_[i] @ (p[:, j] - anchors[i]) for j, i in enumerate(index)], axis=1)
    world = np.stack([(Keys.of(keys[i]).matrix(float(time[j])) @ np.append(p[:, j], 1))[:3] for j, i in enumerate(index)], axis=1)
    pose = poses.at(index, time)
    np.testing.assert_allclose(pose.points(local), frame.points(world), atol=1e-13)
    np.testing.assert_allclose(pose.local_points(frame.points(world)), local, atol=1e-13)
    np.testing.assert_allclose(pose.vectors(pose.local_vectors(p)), p, atol=1e-13)
    for i in range(4):
        lanes = np.nonzero(index == i)[0]
        np.testing.assert_allclose(poses.at(i, time[lanes]).points(local[:, lanes]), frame.points(world)[:, lanes], atol=1e-13)
    assert not poses.is_rigid
    assert Poses.of([Path.of(Keys.of(turned((0, 1))), None, np.ones(3), frame)]).is_rigid


def test_normals_stay_across_the_surface():
    """Of a stretched, mirrored, turning frame: across two tangents that are carried along, and unit."""
    keys = random_keys(5, 2, True)
    path = Path.of(Keys.of(keys), Keys.of(keys).stretch_at(0.5), np.zeros(3), h.UNIT_FRAME)
    pose = Poses.of([path]).at(0, np.float32([0.3, 0.9]))
    a, b = h.directions(1, 2), h.directions(2, 2)
    n, _ = pose.normals(np.cross(a.T, b.T).T)
    for tangent in (a, b):
        assert np.abs(h.dots(n, pose.vectors(tangent))).max() <= 1e-13
    np.testing.assert_allclose(h.dots(n, n), 1, atol=1e-14)


def test_between_is_straight():
    keys = np.array([0.0, 1.0, 5.0])
    assert [between(keys, t) for t in (0, 0.25, 0.5, 0.75, 1)] == [0, 0.5, 1, 3, 5]
    assert math.isnan(between(np.array([0.0, math.nan]), 0.5))
