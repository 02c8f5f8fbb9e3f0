"""Distributed ray tracing: Whitted's picture where nothing has a width, path tracing's where there is one branch."""

import gc

import numpy as np
import pytest

from glanz.engine import AreaLight, Material, Mirror, PerspectiveCamera, PointLight
from glanz.engine.dimensions import Dimension
from glanz.engine.samplers.stratified import Stratified
from glanz.engine.wavefront import branching, visibility
from glanz.engine.wavefront.numbers import Numbers
from glanz.engine.wavefront.records import Rays
from glanz.tests import helpers as h, scenes

DISTRIBUTED = h.settings(width=16, height=16, samples=4, integrator="distributed", max_depth=1, branches=2)
CAMERA = PerspectiveCamera.look_at((3, -4, 2.5), (0, 0, 0.5))


def ball_over_floor(radius=0.0):
    """A mirror ball over a dull floor, which alone sees no other dull surface, under a lamp."""
    ball = h.thing(h.icosphere(2, 0.8, (0, 0, 0.9), smooth=True), Material(name="mirror", lobes=(Mirror((0.9, 0.8, 0.7)),)))
    floor = h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0), name="floor"), h.lambert((0.7, 0.6, 0.5)))
    return h.scene([ball, floor], [PointLight(position=(1, -1, 4), intensity=(40.0,) * 3, radius=radius)], CAMERA)


def test_without_any_width_it_is_whitteds_picture_to_the_bit():
    """F9: a light without a size, a mirror, no lens, and no dull surface that sees another."""
    scene = ball_over_floor()
    assert h.same_bits(h.pixels(scene, DISTRIBUTED), h.pixels(scene, h.replaced(DISTRIBUTED, integrator="whitted")))


def test_the_bits_catch_a_light_with_a_size():
    soft = h.pixels(ball_over_floor(radius=0.5), DISTRIBUTED)
    assert not h.same_bits(soft, h.pixels(ball_over_floor(), DISTRIBUTED))


def test_a_light_that_shrinks_becomes_a_point():
    """F9: the limit of a small light is that of none."""
    almost, point = (h.pixels(ball_over_floor(radius), DISTRIBUTED) for radius in (1e-6, 0.0))
    np.testing.assert_allclose(almost, point, rtol=1e-3, atol=1e-6)


def check_one_branch_is_a_path():
    settings = h.replaced(DISTRIBUTED, branches=1, max_depth=4)
    scene = scenes.everything()
    assert h.same_bits(h.pixels(scene, settings), h.pixels(scene, h.replaced(settings, integrator="path")))


def test_with_one_branch_it_is_path_tracing_to_the_bit():
    check_one_branch_is_a_path()


def test_the_bits_catch_a_branch_that_is_dimmed(monkeypatch):
    monkeypatch.setattr(branching, "thinned", lambda plan, rays, scattered: h.replaced(scattered, beta=scattered.beta / np.float32(1.001)))
    with pytest.raises(AssertionError):
        check_one_branch_is_a_path()


def test_branches_fall_to_one_with_depth():
    plan = h.plan_of(scenes.everything(), h.replaced(DISTRIBUTED, branches=64))
    assert [branching.branches_at(plan, depth) for depth in range(6)] == [64, 16, 4, 1, 1, 1]


def test_the_branches_of_all_samples_are_one_set_of_strata():
    """4 samples with 16 branches each fill the 64 cells of a grid of 8 x 8, one number in each."""
    numbers = Numbers(Stratified, 4)
    cells = []
    for sample in range(4):
        key, sample = np.array([[7], [sample]], np.uint32)
        rays = Rays(*np.zeros((3, 3, 1), np.float32), np.zeros(1), np.zeros(1, int), key, sample, depth=0)
        for i in range(16):
            u2 = numbers.two(branching.split(rays, 16, i), Dimension.DIRECTION)[:, 0]
            cells.append(tuple((u2 * 8).astype(int).tolist()))
    assert len(set(cells)) == 64


def test_splitting_lowers_the_noise_of_soft_shadows_like_samples_do():
    """16 shadow rays for each of 4 samples leave as much noise as 64 samples with one, within a factor of 1.5."""
    lamp = AreaLight(world_from_light=h.affine(translation=(0, 0, 2)), size_x=2, size_y=2, radiance=(3.0,) * 3)
    cover = h.thing(h.quad((0.3, 0.2, 1), (0.8, 0.3, 0), (-0.2, 0.7, 0)), h.lambert(0))
    scene = h.receiver([lamp], [cover], distance=0.5)
    settings = h.replaced(DISTRIBUTED, width=48, height=48, max_depth=0)
    split, samples, few = (h.pixels(scene, h.replaced(settings, branches=b, samples=n))[0].std() for b, n in ((16, 4), (1, 64), (1, 4)))
    assert samples / 1.5 < split < 1.5 * samples
    assert few > 4 * split


def test_the_tree_of_rays_never_exists_as_a_whole(monkeypatch):
    """Depth 3 with 64, 16, 4 branches has 4,000 batches; not more than a few for each depth are alive at a time."""
    alive = []
    meet = visibility.closest

    class Enough(Exception):
        pass

    def counting(plan, carried, o, d, limit=None):
        if len(alive) == 400:
            raise Enough
        alive.append(sum(isinstance(thing, Rays) for thing in gc.get_objects()))
        return meet(plan, carried, o, d, limit)

    monkeypatch.setattr("glanz.engine.plan.closest", counting)
    scene = h.scene([h.thing(h.box(), h.lambert(0.9, emission=1.0))], camera=PerspectiveCamera.look_at((0.3, 0.4, 0.5), (0.9, 0.8, 0.2)))
    with pytest.raises(Enough):
        h.pixels(scene, h.replaced(DISTRIBUTED, branches=64, max_depth=3, width=2, height=2, samples=1))
    # Other rays may have outlived their tests.
    assert max(alive) - alive[0] <= 20
