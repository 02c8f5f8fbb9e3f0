"""Meshes that change their shape, and objects their scale, while the shutter is open; and lamps that move."""

import numpy as np
import pytest

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


def test_a_flat_object_moves_as_any_other():
    """A scale of 0 along the normal: the motion is rigid, and needs no inverse of it."""
    def image(matrix):
        return h.pixels(h.scene([h.replaced(h.thing(h.quad(), GLOW), motion=turned((0, 1.0)) @ matrix)]), h.settings(samples=16))

    assert np.abs(image(np.diag([1.0, 1.0, 0.0, 1.0])) - image(np.eye(4))).max() <= 1 / 16


def test_a_moving_lamp_lights_what_a_still_one_would_on_average():
    """A lamp that slides over a patch gives the mean of the lamps at its places; detects 1 %."""

    def irradiance(seed, **changes):
        scene = h.receiver(objects=[h.replaced(lamp, **changes)])
        return h.pixels(scene, h.settings(samples=256, max_depth=1, seed=seed)).mean(dtype=np.float64)

    lamp = h.thing(h.quad((0, 0, 1), (0.6, 0, 0), (0, 0.4, 0), name="lamp"), h.lambert(0, "light", 1.0))
    moved = [irradiance(seed, motion=shifted((-1, 0, 0), (1, 0, 0.5))) for seed in range(12)]
    places = (np.arange(24) + 0.5) / 24
    still = [irradiance(0, world_from_object=h.affine(translation=(2 * u - 1, 0, 0.5 * u))) for u in places]
    assert h.mean_is(moved, np.mean(still), floor=0.01)
