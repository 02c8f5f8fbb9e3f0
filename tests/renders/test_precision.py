"""What is near to each other stays apart, at any scale and distance, and a picture is the same in every process."""

import hashlib
import math
import os
import subprocess
import sys

import numpy as np
import pytest

from glanz.engine import PerspectiveCamera
from glanz.engine.world import interaction
from glanz.tests import chance, helpers as h, scenes

NEAR, FAR = 1.0, 3.0
"""Radiances of two sheets, the nearer one and the one behind it."""


def swapped(gap, distance=1.0):
    """Of 20 pairs of sheets at random angles, `gap` apart in units of `distance`: the share of 4,096 rays each that see the farther one."""
    wrong = total = 0
    for seed in range(chance.times(20)):
        turn = h.rotation(chance.seeded(seed))
        x, y, normal = turn.T
        eye = distance * h.directions(seed, 1)[:, 0]
        eye *= math.copysign(1, eye @ normal)
        if eye @ normal < 0.3 * distance:  # along the sheets the gap is wider, and so less is asked
            continue
        sheets = [
            h.thing(h.quad(z * normal, 4 * distance * x, 4 * distance * y, name=f"{radiance}"), h.lambert(0, f"{radiance}", radiance))
            for z, radiance in ((0.0, NEAR), (-gap * distance, FAR))
        ]
        scene = h.scene(sheets, camera=PerspectiveCamera.look_at(eye, (0, 0, 0), fov=0.5))
        image = h.pixels(scene, h.replaced(h.settings(width=64, height=64), samples=1))[0]
        wrong += np.count_nonzero(image == FAR)
        total += np.count_nonzero(image)
    assert total > 20_000
    return wrong / total


@pytest.mark.parametrize("distance", [1e-12, 1e-6, 1.0, 1e6, 1e12])
@chance.fresh
def test_of_two_surfaces_the_nearer_one_is_seen(distance):
    """A millionth of the distance apart, none of 5e4 rays sees the farther one: a share below 3e-4."""
    assert swapped(1e-6, distance) == 0


def test_the_order_of_surfaces_is_lost_below_the_rounding_of_coordinates():
    """What is not promised, and that the test above can fail: 1e-7 of the distance apart a tenth of the rays see the farther one."""
    assert swapped(1e-7) > 0.02


def lit(scale):
    """A white ball in a white world, by scattered rays alone, which lose their light where they meet the ball again: (3, 32, 32)."""
    ball = h.thing(h.icosphere(2), h.lambert(1.0), h.affine(scale * h.rotation(1)))
    camera = PerspectiveCamera.look_at(scale * np.array((0.9, -1.2, 0.6)), (0, 0, 0))
    return h.pixels(h.scene([ball], camera=camera, world=1.0), h.settings(width=32, height=32, samples=16, max_depth=0))


@pytest.mark.parametrize("scale", [1e-12, 1e-9, 1e-3, 1e3, 1e9, 1e12])
@chance.fresh
def test_nothing_stands_in_its_own_light(scale):
    """From a picometre to a billion kilometres: each of 1,024 pixels is 1 to 2e-6, so none of 1.6e4 rays meets the ball that it leaves."""
    np.testing.assert_allclose(lit(scale), 1, rtol=2e-6)


def test_its_own_light_catches_rays_that_start_on_the_surface(monkeypatch):
    monkeypatch.setattr(interaction, "START_ULPS", 0)
    assert np.count_nonzero(lit(1e-12)[0] < 0.99) > 100


SCRIPT = """
import hashlib, sys
from glanz.tests import helpers as h, scenes
image = h.pixels(scenes.everything(), h.settings(width=24, height=16, samples=4, max_depth=3, sampler="sobol", threads=2))
print(hashlib.sha256(image.tobytes()).hexdigest())
"""


def test_every_process_renders_the_same_bits():
    """Whatever the order of sets, which Python shuffles by PYTHONHASHSEED, and the place of objects in memory."""
    image = h.pixels(scenes.everything(), h.settings(width=24, height=16, samples=4, max_depth=3, sampler="sobol", threads=2))
    expected = hashlib.sha256(image.tobytes()).hexdigest()
    for number in ("1", "271828"):
        environment = {**os.environ, "PYTHONHASHSEED": number, "PYTHONPATH": os.pathsep.join(sys.path)}
        run = subprocess.run([sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, check=True)
        assert run.stdout.strip() == expected
