"""Skies with a sun: what they give is the integral of what is seen of them, and the sun is not found by chance alone."""

import numpy as np
import pytest

from glanz.engine import Coordinates, LinearTexture, NoiseTexture, SceneError, SkyTexture, World
from glanz.engine.io.scene_file import read_scene, write_scene
from glanz.engine.maths.frames import to_world
from glanz.engine.maths.warps import square_to_cone
from glanz.engine.world import sky as sky_module
from glanz.engine.world.sky import Directions, Disk, Sky
from glanz.tests import helpers as h
from glanz.tests.renders.test_sky import irradiance, under

TURNED = Coordinates(source="generated", matrix=np.block([[h.rotation(4), np.zeros((3, 1))], [np.zeros((1, 3)), 1]]))
HIGH = {"sun_elevation": 0.9, "sun_rotation": 2.0}
NOISE = NoiseTexture(Coordinates(source="generated"), is_coloured=True)
SKIES = {
    "high": SkyTexture(**HIGH),
    "once scattered, large": SkyTexture("single scattering", sun_size=0.2, **HIGH),
    "nishita, setting": SkyTexture("nishita", sun_size=0.1, sun_elevation=0.02),
    "turned": SkyTexture(coordinates=TURNED, sun_elevation=1.5),
}
"""The texture alone is what `integral` takes apart into sky and sun."""


def integral(sky):
    """The irradiance (3,) of a plane that faces +z: the sky by the midpoint rule, and the disk by itself."""
    without = h.replaced(sky, has_disk=False)
    ((towards, radius),) = sky.spots()
    matrix = np.array(sky.coordinates.matrix)[:3, :3]
    grid = np.stack([a.ravel() for a in np.meshgrid(*[(np.arange(256) + 0.5) / 256] * 2)])
    d = to_world((matrix.T @ towards)[:, None], square_to_cone(grid, 2 * np.sin(0.5 * radius) ** 2))
    at = Directions(d.astype(np.float32))
    sun = at.value(sky) - at.value(without)
    return irradiance(without) + (sun * np.maximum(d[2], 0)).mean(axis=1) * 4 * np.pi * np.sin(0.5 * radius) ** 2


def rendered(texture, samples=64):
    return h.pixels(under(texture), h.settings(width=16, height=16, samples=samples, max_depth=1, seed=3)).reshape(3, -1)


@pytest.mark.parametrize("sky", SKIES.values(), ids=SKIES)
def test_a_plane_receives_the_integral_of_sky_and_sun(sky):
    for channel, value in zip(rendered(sky), 0.5 * integral(sky) / np.pi):
        assert h.mean_is(channel, value, floor=2e-3 * value)


def test_the_integral_catches_suns_that_count_twice(monkeypatch):
    monkeypatch.setattr(Disk, "pdf", lambda self, d: np.zeros_like(d[0]))
    with pytest.raises(AssertionError):
        test_a_plane_receives_the_integral_of_sky_and_sun(SKIES["high"])


def test_suns_of_two_skies_are_both_found():
    one, other = SKIES["high"], SkyTexture(sun_elevation=0.5)
    mixed = LinearTexture((one, other), (0.25, 0.5))
    assert len(Sky.of(World(radiance=mixed)).disks) == 2
    expected = 0.25 * integral(one) + 0.5 * integral(other)
    for channel, value in zip(rendered(mixed), 0.5 * expected / np.pi):
        assert h.mean_is(channel, value, floor=2e-3 * value)


def test_the_sun_is_looked_for_by_itself(monkeypatch):
    """Without that it is noise, even where the picture has it."""
    found = rendered(SKIES["high"], 16)
    monkeypatch.setattr(sky_module, "_spots", lambda texture: ())
    by_picture = rendered(SKIES["high"], 16)
    assert (found.std(axis=1) < 0.2 * by_picture.std(axis=1)).all()


def test_the_density_of_a_sky_with_a_sun_is_that_of_its_samples():
    """Its integral is 1: over the sphere by the midpoint rule, over the disk by itself."""
    sky = Sky.of(World(radiance=SKIES["high"]))
    (disk,) = sky.disks
    p = np.zeros((3, 4096), np.float32)
    wi, _, E, pdf = sky.sample(p, h.stratified(1, 64, np.float32))
    inside = disk.pdf(wi) > 0
    assert abs(inside.mean() - disk.chance) < 0.01
    np.testing.assert_allclose(sky.hit(wi)[1], pdf, rtol=1e-5)
    np.testing.assert_allclose(sky.radiance(wi) / pdf, E, rtol=1e-5)
    inverse = (1 / pdf[~inside]).sum() / pdf.size
    assert inverse == pytest.approx(4 * np.pi, rel=0.05)


def test_a_bent_sun_is_still_unbiased():
    """Where a graph bends directions nobody says where the sun is: rays that escape find it."""
    sky = SkyTexture(sun_size=0.5, sun_elevation=0.9)
    bent = h.replaced(sky, coordinates=LinearTexture((Coordinates(source="generated"),), (1.0,)))
    assert Sky.of(World(radiance=bent)).disks == ()
    for channel, value in zip(rendered(bent, 256), 0.5 * integral(sky) / np.pi):
        assert h.mean_is(channel, value, floor=2e-3 * value)


@pytest.mark.parametrize("wrong", [{"model": "hosek"}, {"sun_size": 0.0}, {"air": -1.0}, {"sun_elevation": 2.0}, {"haze": np.nan}])
def test_what_no_sky_has_is_named(wrong):
    with pytest.raises(SceneError, match="sky"):
        SkyTexture(**wrong).check("Day")


def test_a_sky_comes_back_from_a_file(tmp_path):
    scene = under(LinearTexture((SKIES["turned"], NOISE), (0.5, 0.1)))
    write_scene(tmp_path / "sky.glanz", scene, h.settings())
    again, settings = read_scene(tmp_path / "sky.glanz")
    assert h.same_bits(h.pixels(again, settings), h.pixels(scene, h.settings()))
