"""Surfaces that are there in part: alpha, a number or a texture, as on the cards that leaves are painted on."""

import math

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    Bitmap,
    CheckerTexture,
    Coordinates,
    ImageTexture,
    Lambert,
    Material,
    NoiseTexture,
    PerspectiveCamera,
    PointLight,
    SceneError,
    SunLight,
    Transparent,
    read_scene,
    render_image,
    write_scene,
)
from glanz.engine.wavefront import passing
from glanz.tests import helpers as h
from glanz.tests.textured import with_uvs

HALVES = ImageTexture(Bitmap(name="halves", pixels=np.array([0, 255] * 3, np.uint8).reshape(3, 1, 2)), extension="extend", is_smooth=False)
"""Left is not there, right is."""
CLOUD = NoiseTexture(Coordinates(source="generated", matrix=np.diag((4.0, 4.0, 4.0, 1.0))))
FINE = CheckerTexture((0.0,) * 3, (1.0,) * 3, Coordinates(matrix=np.diag((500.0, 500.0, 1.0, 1.0))))
"""Half there, in squares of 2 mm on a metre."""


GREY = (Lambert((0.6, 0.6, 0.6)),)


def card(alpha, lobes=GREY, size=1.0, z=1.0, emission=0.0):
    """A level square with texture coordinates."""
    mesh = with_uvs(h.quad((0, 0, z), (size, 0, 0), (0, size, 0), name="card"))
    return h.thing(mesh, Material(name="leaf", lobes=lobes, alpha=alpha, emission=h.grey(emission)))


def looking_down(objects, lights=(), world=0.0, x=0.0, fov=0.02):
    return h.scene(objects, lights, PerspectiveCamera.look_at((x, 0, 5), (x, 0, 0), up=(0, 1, 0), fov=fov), world)


def seen(scene, **changes):
    """(3, 64) radiance."""
    return h.pixels(scene, h.settings(**changes)).reshape(3, -1).astype(np.float64)


@pytest.mark.parametrize("material", [{"alpha": 0.5}, {"alpha": 1.0, "lobes": (Transparent((0.5,) * 3), Lambert((0.3,) * 3))}], ids=str)
def test_alpha_is_transparent_beside_scaled_lobes(material):
    values = seen(looking_down([card(**material)], [SunLight()], world=0.25), samples=256, max_depth=0)
    assert h.mean_is(values[0], 0.3 * (1 / math.pi + 0.25) + 0.5 * 0.25, floor=1e-6)


def test_alpha_0_is_not_there_and_alpha_1_is_opaque_to_the_bit():
    floor = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0), name="floor"), h.lambert(0.7))
    lights = [SunLight(towards=(0.6, 0.0, 0.8))]
    settings = h.settings(max_depth=3)
    absent, away = (h.pixels(looking_down(objects, lights, 0.2, fov=0.5), settings) for objects in ([floor, card(0.0)], [floor]))
    assert np.abs(absent - away).max() <= 1e-5 * away.max()
    solid, plain = (
        h.pixels(looking_down([floor, h.replaced(card(1.0), materials=(m,))], lights, 0.2, fov=0.5), settings)
        for m in (Material(name="a", lobes=(Lambert(),), alpha=1.0), Material(name="a", lobes=(Lambert(),)))
    )
    assert h.same_bits(solid, plain)


@pytest.mark.parametrize("integrator", ["path", "whitted", "distributed"])
def test_a_cut_out_is_seen_and_casts_its_shadow_without_noise(integrator):
    """Half a card over a glowing floor, and over a floor in the sun: only where it is there."""
    glow = h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0), name="glow"), h.lambert(0, "glow", 2.0))
    leaf = card(HALVES, lobes=())
    for x, expected in ((-0.2, 2.0), (0.2, 0.0), (0.8, 2.0)):
        assert (seen(looking_down([glow, leaf], x=x), samples=2, integrator=integrator) == expected).all()
    for x, expected in ((-0.2, 1.0), (0.2, 0.0), (0.8, 1.0)):
        scene = h.receiver([SunLight()], [leaf], point=(x, 0, 0), distance=0.3, tilt=0.5)
        values = seen(scene, samples=2, max_depth=0, integrator=integrator) * math.pi
        np.testing.assert_allclose(values, expected, rtol=1e-5)


def test_what_is_finer_than_a_pixel_is_half_transparent():
    """Filtered over footprints for paths, point by point for shadow rays."""
    glow = h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0), name="glow"), h.lambert(0, "glow", 2.0))
    assert h.mean_is(seen(looking_down([glow, card(FINE, lobes=())], fov=0.2), samples=64)[0], 1.0)
    lamp = AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 2)), radiance=(1.0,) * 3)
    scenes = (h.receiver([lamp], leaf, distance=0.3, tilt=0.5) for leaf in ([], [card(FINE, size=9)]))
    bare, below = (seen(scene, samples=256, max_depth=0)[0] for scene in scenes)
    assert h.mean_is(below, 0.5 * bare.mean(), floor=1e-3)


@pytest.mark.parametrize("alpha", [0.4, CLOUD, HALVES, FINE], ids=["number", "cloud", "halves", "fine"])
def test_shadow_rays_and_scattered_rays_find_the_same_light_behind_it(alpha):
    lamp = AreaLight(world_from_light=h.affine(np.eye(3), (0.1, 0, 1.5)))
    scene = h.receiver([lamp], [card(alpha)], distance=0.3, tilt=0.5)
    ways = {way: seen(scene, samples=400, max_depth=0, integrator=way, seed=i)[0] for i, way in enumerate(("path", "path_blind"))}
    assert ways["path"].mean() > 0
    assert h.means_agree(ways["path"], ways["path_blind"], floor=1e-4)


@pytest.mark.parametrize("alpha", [CLOUD, 0.3], ids=["cloud", "number"])
def test_a_white_surface_in_even_light_cannot_be_seen_whatever_is_there_of_it(alpha):
    sphere = h.thing(h.icosphere(2), Material(name="sphere", lobes=(Lambert((1.0,) * 3),), alpha=alpha))
    scene = h.scene([sphere], camera=PerspectiveCamera.look_at((0.1, -4, 0.3), (0, 0, 0), fov=0.6), world=1.0)
    image = h.pixels(scene, h.settings(width=24, height=24, samples=64, max_depth=100))
    assert h.mean_is(image[0], 1.0, floor=1e-6)


def test_what_is_emitted_is_not_cut_out():
    """It is seen where nothing is, in every sample, and what is behind it, too."""
    glow = h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0), name="glow"), h.lambert(0, "glow", 2.0))
    for x, expected in ((-0.2, 5.0), (0.2, 3.0)):
        assert (seen(looking_down([glow, card(HALVES, lobes=(), emission=3.0)], x=x), samples=2) == expected).all()


@pytest.mark.parametrize("alpha", [-0.1, 1.1, math.nan])
def test_senseless_alphas_are_refused_by_name(alpha):
    with pytest.raises(SceneError, match=r"material 'leaf': alpha is .*, allowed: 0 to 1"):
        render_image(looking_down([card(alpha)]), h.settings())


@pytest.mark.parametrize("alpha", [0.25, HALVES], ids=["number", "texture"])
def test_alpha_is_the_same_again_after_reading(tmp_path, alpha):
    scene = looking_down([card(alpha)], [PointLight(position=(0.0, 0.0, 3.0))])
    write_scene(tmp_path / "a.glanz", scene, h.settings())
    again, settings = read_scene(tmp_path / "a.glanz")
    assert h.same_bits(h.pixels(again, settings), h.pixels(scene, h.settings()))


def test_cut_outs_catch_shadows_of_the_whole_card(monkeypatch):
    monkeypatch.setattr(passing, "_transmittance", lambda plan, rays, o, d, limit: 0 * o)
    with pytest.raises(AssertionError):
        test_a_cut_out_is_seen_and_casts_its_shadow_without_noise("path")


def test_alpha_catches_what_stays_at_full_weight(monkeypatch):
    looked_up = passing._looked_up
    monkeypatch.setattr(passing, "_looked_up", lambda *args, **kind: ((found := looked_up(*args, **kind))[0] ** 2, found[1]))
    with pytest.raises(AssertionError):
        test_alpha_is_transparent_beside_scaled_lobes({"alpha": 0.5})
