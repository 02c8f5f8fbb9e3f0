"""Light that passes a thin sheet and is scattered: against closed forms, by every way that finds it."""

import math

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    Dielectric,
    ImageTexture,
    Lambert,
    LambertTransmission,
    Material,
    Medium,
    Mirror,
    PerspectiveCamera,
    Phong,
    PhongTransmission,
    PointLight,
    SunLight,
)
from glanz.engine.maths.mipmaps import decoding_table
from glanz.engine.wavefront import direct
from glanz.engine.wavefront.direct import shadow_rays_in_front, shadow_rays_on_either_side
from glanz.engine.world.accel import Accel
from glanz.engine.world.materials import Reflection, TwoSided
from glanz.tests import chance, helpers as h, textured
from glanz.tests.renders.test_two_ways import image_of

PAPER = Material(name="paper", lobes=(LambertTransmission((0.9, 0.6, 0.3)),))
WHITE_PAPER = Material(name="white paper", lobes=(LambertTransmission((1.0, 1.0, 1.0)),))
FILM = Material(name="film", lobes=(PhongTransmission((1.0, 1.0, 1.0), 8.0),))
LEAF = Material(name="leaf", lobes=(Lambert((0.4,) * 3), LambertTransmission((0.5,) * 3)))
SATIN = Material(name="satin", lobes=(Phong((0.3,) * 3, 20.0), PhongTransmission((0.4,) * 3, 5.0), LambertTransmission((0.3,) * 3)))
BEHIND = PointLight(position=(1.0, 2.0, -2.0), intensity=(3.0, 2.0, 1.0))
IN_FRONT = PointLight(position=(1.0, 2.0, 2.0), intensity=(3.0, 2.0, 1.0))
LAMP = h.thing(h.quad((0.5, 0.5, -0.5), (2, 0, 0), (0, 2, 0), name="lamp"), h.lambert(0, "lamp", 2.0))
RECEIVED = np.array((3.0, 2.0, 1.0)) / 9 * 2 / 3
"""Irradiance of the sheet at the origin, on the side of the lamp: I cos / d^2."""


def seen(scene, **changes):
    """Radiance (3, 64) of each pixel."""
    return h.pixels(scene, h.settings(**{"max_depth": 0, **changes})).reshape(3, -1).astype(np.float64)


@pytest.mark.parametrize("integrator", ["path", "distributed", "whitted"])
def test_paper_shows_the_light_behind_it(integrator):
    """k_t E / pi, from every side and to 1e-5; light on the viewer's side does not count."""
    for tilt in (0.0, 0.7, 1.4):
        image = seen(h.receiver([BEHIND], material=PAPER, tilt=tilt), samples=1, integrator=integrator)
        truth = np.array((0.9, 0.6, 0.3)) * RECEIVED / math.pi
        np.testing.assert_allclose(image, np.broadcast_to(truth[:, None], image.shape), rtol=1e-5)
    assert not seen(h.receiver([IN_FRONT], material=PAPER), samples=1, integrator=integrator).any()


def test_a_leaf_shows_the_light_of_both_sides():
    for light, share in ((IN_FRONT, 0.4), (BEHIND, 0.5)):
        image = seen(h.receiver([light], material=LEAF), samples=1)
        np.testing.assert_allclose(image, np.broadcast_to((share * RECEIVED / math.pi)[:, None], image.shape), rtol=1e-5)


def test_a_film_shows_the_lobe_about_the_way_straight_on():
    """k_t (n + 2) / (2 pi) cos^n, times the cosine on the sheet, for a lamp behind it."""
    for tilt in (0.0, 0.5):
        wo = np.array((math.sin(tilt), 0, math.cos(tilt)))
        straight = h.frame_towards((0, 0, 1)) @ wo
        cos = -straight @ np.array((1.0, 2.0, -2.0)) / 3
        image = seen(h.receiver([BEHIND], material=FILM, tilt=tilt), samples=1)
        truth = 10 / (2 * math.pi) * cos**8 * RECEIVED
        np.testing.assert_allclose(image, np.broadcast_to(truth[:, None], image.shape), rtol=1e-4)


def test_the_sun_shines_through_paper():
    """A light infinitely far away, on the far side."""
    image = seen(h.receiver([SunLight(towards=(0.6, 0.0, -0.8), irradiance=(3.0,) * 3)], material=WHITE_PAPER), samples=1)
    np.testing.assert_allclose(image, 2.4 / math.pi, rtol=1e-5)


def test_the_illumination_model_has_a_term_for_each_side():
    """k_t (-n . l) I_L through paper, k_t (-v . l)^n through film; nothing of the terms of reflection from behind."""
    model = {"integrator": "whitted_phong", "samples": 1}
    image = seen(h.receiver([BEHIND], material=WHITE_PAPER), **model)
    np.testing.assert_allclose(image, np.broadcast_to(RECEIVED[:, None], image.shape), rtol=1e-5)
    image = seen(h.receiver([BEHIND], material=FILM), **model)
    np.testing.assert_allclose(image, np.broadcast_to((RECEIVED * 1.5 * (2 / 3) ** 8)[:, None], image.shape), rtol=1e-4)
    grazing = h.receiver([BEHIND], material=Material(name="m", lobes=(Phong((0.5,) * 3, 0.5), LambertTransmission((0.5,) * 3))), tilt=1.4)
    image = seen(grazing, **model)
    np.testing.assert_allclose(image, np.broadcast_to((0.5 * RECEIVED)[:, None], image.shape), rtol=1e-5)


@pytest.mark.parametrize("side", ["front", "behind"])
def test_what_stands_behind_the_sheet_throws_a_shadow_on_it(side):
    z = -0.5 if side == "behind" else 0.5
    screen = h.thing(h.quad((0.25, 0.5, z), (2, 0, 0), (0, 2, 0), name="screen"), h.lambert(0.0))
    scene = h.receiver([BEHIND], [screen], material=WHITE_PAPER, distance=0.2)
    image = seen(scene, samples=1)
    assert image.any() == (side == "front")


@pytest.mark.parametrize("material", [WHITE_PAPER, FILM, LEAF, SATIN], ids=lambda m: m.name)
@pytest.mark.parametrize("name", ["lamp", "panel", "bulb"])
@chance.fresh
def test_every_way_finds_the_light_behind(monkeypatch, material, name):
    """E14 through a sheet: shadow rays, scattered rays, both; Welch's t over 144 pixels, detects 3 %."""
    lights, objects = {
        "lamp": ([], [h.thing(h.quad((0.1, 0.2, -0.7)), h.lambert(0, "lamp", 1.0))]),
        "panel": ([AreaLight(world_from_light=h.affine(np.diag((1.0, -1, -1)), (0.1, 0.2, -0.7)))], []),
        "bulb": ([PointLight(position=(0.1, 0.2, -1.0), radius=0.6, soft_falloff=False)], []),
    }[name]
    scene = h.receiver(lights, objects, material=material, distance=0.3, tilt=0.5)
    images = {way: image_of(monkeypatch, way, scene, seed) for seed, way in enumerate(("shadow rays", "scattered rays", "both"))}
    assert images["both"].mean() > 0
    assert h.means_agree(images["shadow rays"], images["both"], floor=1e-4)
    assert h.means_agree(images["scattered rays"], images["both"], floor=1e-4)


@pytest.mark.parametrize("integrator", ["path_blind", "path_naive", "distributed"])
@pytest.mark.parametrize("material", [LEAF, SATIN], ids=lambda m: m.name)
def test_every_integrator_sees_the_same_through_a_sheet(integrator, material):
    """A closed translucent box in a bright world, a lamp below it; up to 3 bounces. Detects 2 %."""
    scene = h.scene([h.thing(h.box(), material), LAMP], camera=PerspectiveCamera.look_at((2, -2, 1), (0.5, 0.5, 0.5)), world=0.3)
    settings = h.settings(width=12, height=12, max_depth=3)
    reference = h.pixels(scene, h.replaced(settings, samples=256))[0]
    image = h.pixels(scene, h.replaced(settings, samples=16 if integrator == "distributed" else 512, integrator=integrator, seed=1))[0]
    assert h.mean_is((image - reference).astype(np.float64), 0.0, absolute=1e-3 * reference.mean())


@pytest.mark.parametrize("material", [WHITE_PAPER, Material(name="leaf", lobes=(Lambert((0.5,) * 3), LambertTransmission((0.5,) * 3)))])
@chance.fresh
def test_a_white_sheet_vanishes_in_white_light(material):
    """F2: in radiance 1 from everywhere all that is reflected and passed adds up to 1, also through a closed box."""
    for mesh in (h.quad(), h.box((-1, -1, -1))):
        image = h.pixels(h.scene([h.thing(mesh, material)], world=1.0), h.settings(width=16, height=16, samples=16, max_depth=64))
        assert h.mean_is(image[0], 1.0, floor=1e-3)


def test_a_leaf_shows_its_picture_against_the_light():
    """Textures tint what passes, texel by texel: under an even sky of 1 a sheet shows its transmittance."""
    square = textured.with_uvs(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)))
    texture = ImageTexture(textured.PICTURE, extension="extend", is_smooth=False)
    for lobe in (LambertTransmission(texture), PhongTransmission(texture, 0.0)):
        scene = textured.facing(square, Material(name="leaf", lobes=(lobe,)), world=1.0)
        image = h.pixels(scene, h.settings(width=16, height=8, samples=256, max_depth=1))
        texels = decoding_table(True).take(textured.PICTURE.pixels)[:, ::-1]
        np.testing.assert_allclose(image, texels, rtol=0, atol=2e-5 if type(lobe) is LambertTransmission else 0.2)
        assert image.mean() == pytest.approx(texels.mean(), rel=5e-3)


@pytest.mark.parametrize("degrees", [0, 40, 70])
def test_a_clear_film_weakens_by_the_cosine_and_nothing_else(degrees):
    """n = 1e6: what is behind is seen as it is, times cos of incidence; to 0.5 %."""
    material = Material(name="clear", lobes=(PhongTransmission((1.0,) * 3, 1e6),))
    lamp = h.thing(h.quad((0, 0, -1), (40, 0, 0), (0, 40, 0), name="lamp"), h.lambert(0, "lamp", 1.0))
    scene = h.receiver(objects=[lamp], material=material, tilt=math.radians(degrees))
    assert seen(scene, samples=64).mean() == pytest.approx(math.cos(math.radians(degrees)), rel=5e-3)


def test_the_lamp_behind_does_not_stand_in_its_own_light(monkeypatch):
    """A9 from the other side: 0 of 1e5 shadow rays that start behind the sheet are blocked, by the sheet or by the lamp."""
    turn = h.affine(h.rotation(4), (300.0, -200.0, 100.0))
    sheet = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0), name="sheet"), WHITE_PAPER, turn)
    lamp = h.thing(h.quad((0.1, 0.2, -1), (0.7, 0, 0), (0, 0.5, 0), name="lamp"), h.lambert(0, "light", 1.0), turn)
    eye, target = (turn[:3, :3] @ np.array(p) + turn[:3, 3] for p in ((0.5, -3, 2.0), (0.1, 0.2, 0)))
    calls = h.spy(monkeypatch, Accel, "occluded")
    h.pixels(h.scene([sheet, lamp], camera=PerspectiveCamera.look_at(eye, target)), h.settings(width=128, height=128, samples=9))
    asked = sum(np.count_nonzero(call.args[3] > 0) for call in calls)
    assert asked > 50_000
    assert sum(np.count_nonzero(call.result & (call.args[3] > 0)) for call in calls) == 0


def test_light_through_a_sheet_is_absorbed_behind_it():
    """A closed lampshade of paper full of a medium, a point light in it: k_t / pi I cos / d^2 exp(-sigma d)."""
    shade = Material(name="shade", lobes=(LambertTransmission((0.5,) * 3),), medium=Medium(absorption=(0.0, 1.0, 2.0)))
    light = PointLight(position=(0.5, 0.5, 0.5), intensity=(4.0,) * 3)
    camera = PerspectiveCamera.look_at((0.5, -3, 0.5), (0.5, 0, 0.5), fov=1e-4)
    image = seen(h.scene([h.thing(h.box(), shade)], [light], camera), samples=1)
    truth = 0.5 / math.pi * 4 / 0.25 * np.exp(-0.5 * np.array((0.0, 1.0, 2.0)))
    np.testing.assert_allclose(image, np.broadcast_to(truth[:, None], image.shape), rtol=1e-4)


def test_only_sheets_pay_for_the_other_side():
    """Mirrors, glass and all that reflects take the plain choices."""
    for lobe in (Lambert(), Phong(), Mirror(), Dielectric(), LambertTransmission(), PhongTransmission()):
        is_asked = lobe.transmits and not lobe.is_specular
        plan = h.plan_of(h.scene([h.thing(h.quad(), Material(name="m", lobes=(lobe,)))], [BEHIND]), h.settings())
        assert plan.shadow_rays is (shadow_rays_on_either_side if is_asked else shadow_rays_in_front)
        assert plan.world.materials.kind is (TwoSided if is_asked else Reflection)


def shade_over_lamp(scale=1.0):
    """A closed box of satin over a lamp, under a bulb, in a bright world."""
    box, lamp = (h.thing(o, m, h.affine(scale * np.eye(3))) for o, m in ((h.box(), SATIN), (LAMP.mesh, LAMP.materials[0])))
    light = PointLight(position=(0.5 * scale, 0.25 * scale, 2 * scale), intensity=(scale**2,) * 3, radius=0.25 * scale)
    return h.scene([box, lamp], [light], PerspectiveCamera.look_at(np.array((2, -2, 1)) * scale, np.full(3, 0.5 * scale)), world=0.3)


@pytest.mark.parametrize("integrator", ["path", "path_naive", "distributed"])
def test_threads_tiles_and_batches_change_no_bit(monkeypatch, integrator):
    """H3 through sheets."""
    settings = h.settings(width=12, height=8, max_depth=3, integrator=integrator)
    reference = h.pixels(shade_over_lamp(), settings)
    assert h.same_bits(h.pixels(shade_over_lamp(), h.replaced(settings, threads=2, tile_size=3)), reference)
    monkeypatch.setattr("glanz.engine.rendering.LANES", 7)
    assert h.same_bits(h.pixels(shade_over_lamp(), settings), reference)


@pytest.mark.parametrize("k", [-30, 30])
def test_a_power_of_two_as_scale_changes_no_bit(k):
    """A2 through sheets."""
    settings = h.settings(width=12, height=8, max_depth=3)
    assert h.same_bits(h.pixels(shade_over_lamp(2.0**k), settings), h.pixels(shade_over_lamp(), settings))


# Mutants


def test_paper_catches_light_that_counts_on_the_wrong_side(monkeypatch):
    monkeypatch.setattr(TwoSided, "_on_its_side", Reflection._on_its_side)
    with pytest.raises(AssertionError):
        test_a_leaf_shows_the_light_of_both_sides()


def test_paper_catches_shadow_rays_that_start_on_the_viewers_side(monkeypatch):
    plan_of = h.plan_of
    scene = h.receiver([BEHIND], material=WHITE_PAPER)
    plan = plan_of(scene, h.settings(max_depth=0))
    assert h.pixels_of_plan(plan).min() > 0
    assert h.pixels_of_plan(h.replaced(plan, shadow_rays=shadow_rays_in_front)).max() == 0


def test_the_lampshade_catches_shadow_rays_that_carry_the_outside(monkeypatch):
    either = direct.shadow_rays_on_either_side

    def forgetful(plan, rays, *others):
        return (rays, *either(plan, rays, *others)[1:])

    monkeypatch.setattr("glanz.engine.plan.shadow_rays_on_either_side", forgetful)
    with pytest.raises(AssertionError):
        test_light_through_a_sheet_is_absorbed_behind_it()


def test_the_lamp_behind_catches_shadow_rays_to_where_it_was_seen_from_the_front(monkeypatch):
    """The mutant starts behind the sheet, but goes as far as from its front: it ends on the far side of the lamp."""

    def too_far(plan, rays, surface, reflection, wi, distance):
        shadow, o, _, _ = shadow_rays_on_either_side(plan, rays, surface, reflection, wi, distance)
        return shadow, o, wi, distance

    monkeypatch.setattr("glanz.engine.plan.shadow_rays_on_either_side", too_far)
    with pytest.raises(AssertionError):
        test_the_lamp_behind_does_not_stand_in_its_own_light(monkeypatch)
