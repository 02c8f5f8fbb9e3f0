"""Meshes that change their shape, and objects their scale, while the shutter is open; and lamps that move."""

import numpy as np
import pytest

from glanz.engine import OrthographicCamera, PerspectiveCamera, PointLight
from glanz.engine.maths.poses import Keys
from glanz.engine.wavefront import motion
from glanz.engine.world.moving_lamps import MovingLamps
from glanz.tests import helpers as h
from glanz.tests.moving import GLOW, from_above, is_share, shifted, trapezoid, turned


def test_a_mesh_that_deforms_is_blurred_in_as_many_steps_as_the_setting_says():
    """A bar whose vertices travel as in G5: its profile is a staircase of `motion_steps`, and its mean is right for any number."""
    quad = h.quad(y=(0, 20, 0))
    shapes = np.stack([quad.vertices + np.array([[x], [0], [0]]) for x in (-1.5, 1.5)])
    scene = h.scene([h.thing(h.replaced(quad, shapes=shapes), GLOW)], camera=from_above(5))
    x = (np.arange(80) + 0.5) / 16 - 2.5
    truth = trapezoid(x, 3.0, 1 / 16)
    errors = []
    for steps in (3, 12, 48):
        row = h.pixels(scene, h.settings(width=80, height=1, samples=4096, motion_steps=steps))[0, 0].astype(np.float64)
        places = -1.5 + 3 * (np.arange(steps) + 0.5) / steps
        stairs = np.mean([trapezoid(x - place, 0, 1 / 16) for place in places], axis=0)
        assert np.abs(row - stairs).max() <= 0.02
        assert row.mean() == pytest.approx(truth.mean(), rel=0.01)
        errors.append(np.abs(row - truth).mean())
    assert errors[0] > 2 * errors[1] > 4 * errors[2]


def test_an_object_that_moves_while_it_deforms_is_carried_without_steps():
    """The bar moves by its object, and only breathes by its shape: with one step the trapezoid is exact."""
    quad = h.quad(y=(0, 20, 0))
    shapes = np.stack([quad.vertices * [[1], [y], [1]] for y in (0.9, 1.1)])
    bar = h.replaced(h.thing(h.replaced(quad, shapes=shapes), GLOW), motion=shifted((-1.5, 0, 0), (1.5, 0, 0)))
    settings = h.settings(width=80, height=1, samples=1024, motion_steps=1, sampler="random")
    row = h.pixels(h.scene([bar], camera=from_above(5)), settings)[0, 0]
    assert is_share(row, trapezoid((np.arange(80) + 0.5) / 16 - 2.5, 3.0, 1 / 16), 1024)


def test_a_stretch_through_flatness_is_a_deformation():
    """An object that is turned inside out by its scale has no inverse on the way; it is seen all the same, and warns of nothing."""
    keys = np.stack([h.affine(np.diag([1.0, 1.0, z])) for z in (1.0, -1.0)])
    ball, settings = h.thing(h.icosphere(2), GLOW), h.settings(samples=64, motion_steps=16)
    image = h.pixels(h.scene([h.replaced(ball, motion=keys)]), settings)
    flat = h.pixels(h.scene([h.replaced(ball, world_from_object=np.diag([1.0, 1.0, 0.01, 1.0]))]), settings)
    full = h.pixels(h.scene([ball]), settings)
    assert 1.05 * flat.sum() < image.sum() < 0.95 * full.sum()


def test_an_object_that_grows_from_nothing_is_seen():
    """From no size to full: the ball covers a third of the area of its disk, on average, in all of the time."""
    keys = np.stack([h.affine(s * np.eye(3)) for s in (0.0, 1.0)])
    camera = OrthographicCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0), height=2.5)
    ball = h.thing(h.icosphere(3), GLOW)
    settings = h.settings(width=16, height=16, samples=256, motion_steps=32)
    grown = h.pixels(h.scene([h.replaced(ball, motion=keys)], camera=camera), settings).mean(dtype=np.float64)
    full = h.pixels(h.scene([ball], camera=camera), settings).mean(dtype=np.float64)
    assert grown == pytest.approx(full / 3, rel=0.02)


def test_a_flat_object_moves_as_any_other():
    """A scale of 0 along the normal: the motion is rigid, and needs no inverse of it."""

    def image(matrix):
        return h.pixels(h.scene([h.replaced(h.thing(h.quad(), GLOW), motion=turned((0, 1.0)) @ matrix)]), h.settings(samples=16))

    assert np.abs(image(np.diag([1.0, 1.0, 0.0, 1.0])) - image(np.eye(4))).max() <= 1 / 16


LAMP = h.thing(h.quad((0, 0, 1), (0.6, 0, 0), (0, 0.4, 0), name="lamp"), h.lambert(0, "light", 1.0))
TREMBLING = np.stack([LAMP.mesh.vertices * np.array([[s], [1], [1]]) for s in (0.2, 3.0)])
LAMPS = {
    "sliding": {"motion": shifted((-1, 0, 0), (1, 0, 0.5))},
    "turning over": {"motion": np.stack([h.affine(h.rotation(5)), h.affine(h.rotation(6), (0.2, 0, 0.5))])},
    "growing": {"motion": np.stack([h.affine(np.diag([0.5, 1, 1])), h.affine(np.diag([3.0, 2, 1.5]))])},
    "deforming": {"mesh": h.replaced(LAMP.mesh, shapes=TREMBLING)},
}


def irradiance(lamp, seed, lamps=(), **changes):
    """Of a patch under `lamp`, by one render."""
    settings = h.settings(**{"samples": 64, "max_depth": 1, "seed": seed, **changes})
    return h.pixels(h.receiver(lamps, objects=[lamp], distance=0.2), settings).mean(dtype=np.float64)


@pytest.mark.parametrize("name", LAMPS)
def test_a_moving_lamp_gives_what_it_gives_at_each_time_on_average(name):
    """Against the mean of still lamps, at the 32 middles of parts of the shutter; 1 % is noticed. Shadow rays share with scattered ones."""
    lamp = h.replaced(LAMP, **LAMPS[name])
    moved = [irradiance(lamp, seed, motion_steps=32) for seed in range(16)]
    still = []
    for time in (np.arange(32) + 0.5) / 32:
        matrix = Keys.of(lamp.motion).matrix(time) if lamp.moves else np.eye(4)
        still.append(irradiance(h.replaced(LAMP, mesh=lamp.mesh.at(time), world_from_object=matrix), 0, samples=256, sampler="sobol"))
    assert h.mean_is(moved, np.mean(still), floor=3e-3)
    assert np.std(still) > 0.05 * np.mean(still)


@pytest.mark.parametrize("name", LAMPS)
@pytest.mark.parametrize("integrator", ["path_blind", "distributed"])
def test_all_ways_to_a_moving_lamp_find_the_same(name, integrator):
    """Also beside other lights to choose from."""
    lamp, others = h.replaced(LAMP, **LAMPS[name]), [PointLight(position=(1, 2, 3), intensity=(0.3,) * 3)]
    samples = {"path_blind": 4096, "distributed": 16}[integrator]
    settings = {"integrator": integrator, "samples": samples, "width": 4, "height": 4}
    lamps = others if integrator == "distributed" else []
    a = [irradiance(lamp, seed, lamps, **settings) for seed in range(12)]
    b = [irradiance(lamp, seed + 100, lamps) for seed in range(12)]
    assert h.means_agree(a, b, floor=2e-3)
    assert np.mean(b) > 0


def test_the_average_catches_a_lamp_that_is_sampled_where_it_is_in_the_middle(monkeypatch):
    at = MovingLamps.at
    monkeypatch.setattr(MovingLamps, "at", lambda self, lamp, time: at(self, lamp, np.full_like(time, 0.5)))
    with pytest.raises(AssertionError):
        test_a_moving_lamp_gives_what_it_gives_at_each_time_on_average("sliding")


def test_a_moving_lamp_does_not_stand_in_its_own_light(monkeypatch):
    """A9: 0 of about 1e5 shadow rays to a lamp that turns are blocked, at scales from 1e-6 to 1e6."""
    for scale in (1e-6, 1.0, 1e6):
        matrix = np.diag([scale] * 3 + [1])
        keys = np.stack([matrix @ h.affine(r, (0, 0, z)) for r, z in ((h.rotation(5), 2.0), (h.rotation(6), 3.0))])
        lamp = h.replaced(h.thing(h.quad(x=(0.7, 0, 0), y=(0, 0.5, 0), name="lamp"), h.lambert(0, "light", 1.0)), motion=keys)
        floor = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0), name="floor"), h.lambert(0.5), matrix)
        camera = PerspectiveCamera.look_at((0.5 * scale, -3 * scale, 2 * scale), (0, 0, 0))
        with monkeypatch.context() as patch:
            calls = h.spy(patch, motion, "occluded_at_time")
            patch.setattr("glanz.engine.plan.occluded_at_time", motion.occluded_at_time)
            h.pixels(h.scene([floor, lamp], camera=camera), h.settings(width=64, height=64, samples=16, max_depth=0))
        asked = sum(np.count_nonzero(call.args[4] > 0) for call in calls)
        assert asked > 30_000
        assert sum(np.count_nonzero(call.result & (call.args[4] > 0)) for call in calls) == 0
