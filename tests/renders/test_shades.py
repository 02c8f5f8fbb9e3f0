"""Lights behind textures: what shadow rays bring is what scattered rays and the camera find."""

import numpy as np
import pytest

from glanz.engine import AreaLight, Coordinates, LinearTexture, NoiseTexture, PerspectiveCamera, PointLight, Shade
from glanz.engine.world.lights import Group
from glanz.tests import helpers as h

ABOVE = h.affine(translation=(0.1, 0.2, 0.6))
NOISE = NoiseTexture(Coordinates(source="object"), scale=4.0, is_coloured=True)


def lit():
    """A white point under a large square and a ball, both patchy."""
    shade = Shade(texture=LinearTexture((NOISE,), (2.0,), (-0.5,) * 3), world_from_light=ABOVE)
    square = AreaLight(world_from_light=ABOVE, size_x=1.5, size_y=1.0, shade=shade)
    ball = PointLight(position=(-0.6, 0.1, 0.5), radius=0.4, soft_falloff=False, shade=shade)
    return h.receiver([square, ball], distance=0.3)


def found_by(integrator):
    return h.pixels(lit(), h.settings(integrator=integrator, samples=400, max_depth=1)).reshape(3, -1)


def check_both_ways():
    # 64 pixels of 400 samples: a percent of either.
    both, blind = found_by("path"), found_by("path_blind")
    assert all(h.means_agree(a, b) for a, b in zip(both, blind))


def test_patchy_lights_are_found_by_shadow_rays_and_scattered_ones_alike():
    check_both_ways()


def test_a_light_that_casts_shadows_without_its_texture_is_noticed(monkeypatch):
    monkeypatch.setattr(Group, "_sample", lambda self, k, p, u2: self.light.sample(k, p, u2))
    with pytest.raises(AssertionError):
        check_both_ways()


def test_the_camera_sees_the_texture_of_a_light():
    """uv grow to the right and up, as the light is seen from its back: from its front to the left."""
    matrix = h.affine(np.diag((1, -1, -1)), (0, 0, 0))
    shade = Shade(texture=LinearTexture((Coordinates(),), (1.0,)), world_from_light=matrix)
    light = AreaLight(world_from_light=matrix, size_x=2.0, size_y=2.0, is_visible=True, shade=shade)
    camera = PerspectiveCamera.look_at((0, 0, 10), (0, 0, 0), up=(0, 1, 0), fov=2 * np.arctan(0.1))
    seen = h.pixels(h.scene([], [light], camera), h.settings(samples=16, filter_width=1.0))
    middles = (np.arange(8) + 0.5) / 8
    np.testing.assert_allclose(seen[0], np.broadcast_to(middles, (8, 8)), atol=0.02)
    np.testing.assert_allclose(seen[1], np.broadcast_to(middles[:, None], (8, 8)), atol=0.02)
