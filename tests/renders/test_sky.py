"""Worlds that are a texture of all directions: what they give is the integral of what is seen of them."""

import numpy as np
import pytest

from glanz.engine import Coordinates, EnvironmentMap, EnvironmentTexture, GradientTexture, LinearTexture, NoiseTexture, World
from glanz.engine.io.scene_file import read_scene, write_scene
from glanz.engine.maths.equirect import square_to_direction
from glanz.engine.requirements import Requirements
from glanz.engine.world.environment import Environment
from glanz.engine.world.sky import Directions, Sky
from glanz.tests import helpers as h, textured as t

PICTURE = EnvironmentMap(pixels=np.random.default_rng(1).random((3, 8, 16)))
DIRECTION = Coordinates(source="generated")
SPOT = ((4, 0, 0, 0), (0, 4, 0, 0), (0, 0, 4, -4), (0, 0, 0, 1))
SKIES = {
    "picture": EnvironmentTexture(PICTURE),
    "noise": NoiseTexture(DIRECTION, is_coloured=True),
    "gradient from below": GradientTexture("linear", Coordinates(source="generated", matrix=np.eye(4)[[2, 0, 1, 3]])),
    "black but for a spot": LinearTexture((GradientTexture("quadratic sphere", Coordinates(source="generated", matrix=SPOT)),), (50.0,)),
}


def irradiance(texture):
    """On a plane that faces +z, by the midpoint rule (3,)."""
    u, v = (a.ravel() for a in np.meshgrid((np.arange(1024) + 0.5) / 1024, (np.arange(512) + 0.5) / 512))
    d = square_to_direction(u, v)
    L = np.broadcast_to(np.maximum(Directions(d.astype(np.float32)).value(texture), 0), d.shape)
    return (L * (np.sin(np.pi * v) * (2 * np.pi / 1024) * (np.pi / 512) * np.maximum(d[2], 0))).sum(axis=1)


def under(texture):
    """A dull plane that fills the picture."""
    scene = t.facing(h.quad((0, 0, 0), (3, 0, 0), (0, 3, 0)), h.lambert(0.5))
    return h.replaced(scene, world=World(radiance=texture))


@pytest.mark.parametrize("texture", SKIES.values(), ids=SKIES)
def test_a_plane_receives_the_integral_of_the_sky(texture):
    pixels = h.pixels(under(texture), h.settings(width=16, height=16, samples=256, max_depth=1, seed=2))
    expected = 0.5 * irradiance(texture) / np.pi
    for channel, value in zip(pixels.reshape(3, -1), expected):
        assert h.mean_is(channel, value, floor=1e-3)


def test_the_integral_catches_samples_of_the_picture_by_which_directions_are_chosen(monkeypatch):
    monkeypatch.setattr(Sky, "sample", Environment.sample)
    with pytest.raises(AssertionError):
        test_a_plane_receives_the_integral_of_the_sky(SKIES["picture"])


def test_a_picture_is_the_same_as_a_texture_or_as_an_environment():
    d = h.directions(1, 4096, np.float32)
    turned = EnvironmentMap(pixels=PICTURE.pixels, world_from_map=((0, -1, 0), (1, 0, 0), (0, 0, 1)), strength=(1, 2, 3))
    seen = Environment.of(World(environment=turned)).radiance(d)
    np.testing.assert_allclose(Directions(d).value(EnvironmentTexture(turned)), seen, atol=1e-5)


def test_skies_ask_by_name_and_come_back_from_files(tmp_path):
    scene = under(SKIES["noise"])
    assert Requirements.of(scene, h.settings()).as_dict()["environment"] == ["World"]
    write_scene(tmp_path / "sky.glanz", scene, h.settings())
    again, settings = read_scene(tmp_path / "sky.glanz")
    assert h.same_bits(h.pixels(again, settings), h.pixels(scene, h.settings()))
