"""Rough boundaries between media: bodies in bodies, a camera in one of them, and what is absorbed behind."""

import numpy as np
import pytest

from glanz.engine import (
    Dielectric,
    GgxAlbedo,
    Gloss,
    LinearTexture,
    LobeExponent,
    Material,
    Medium,
    OrthographicCamera,
    PerspectiveCamera,
    RelativeIndex,
    Requirements,
    RoughRefraction,
    needs,
    render_image,
    rendering,
)
from glanz.engine.wavefront import continuation, direct, media
from glanz.engine.world import compile
from glanz.tests import helpers as h
from glanz.tests.renders.test_media import FLOOR, GLOW, OPEN, incoherent, layered, seen
from glanz.tests.renders.test_media_at_random import OUTSIDE, heap, index_at

FINE, COARSE = 0.03, 0.4
"""Roughness of what is all but smooth, and of what is not."""


def rough(ior, roughness):
    """The lobes of a clear boundary with GGX's share of light."""
    eta = RelativeIndex(ior)
    share = GgxAlbedo(roughness, eta, kind="boundary")
    passed = LinearTexture((share,), (-1.0,), 1.0)
    return Gloss(share, LobeExponent(roughness)), RoughRefraction(passed, LobeExponent(roughness, eta), eta)


def slab(low, high, lobes, absorption=0.0, priority=0, side=4.0):
    material = Material(name=f"{low}", lobes=lobes, medium=Medium(absorption=h.grey(absorption), priority=priority))
    return h.thing(h.box((-side, -side, low), (side, side, high), name=f"{low}"), material)


@pytest.mark.parametrize(
    ("things", "indices"),
    [
        ([slab(0, 3, rough(1.5, FINE)), slab(1, 2, rough(2.4, FINE), side=3.0)], (1, 1.5, 2.4, 1.5, 1)),
        ([slab(0, 3, (Dielectric(2.0),)), slab(1, 2, rough(1.0, FINE), side=3.0)], (1, 2, 1, 2, 1)),
        ([slab(0, 2, rough(2.4, FINE), 0, 1), slab(1, 3, (Dielectric(1.33),))], (1, 2.4, 1.33, 1)),
        ([slab(0, 2, rough(2.4, FINE)), slab(1, 3, rough(1.33, FINE), 0, 1)], (1, 2.4, 1.33, 1)),
        ([slab(0, 4, rough(2.0, FINE), 0, 2), slab(1, 2, rough(1.2, FINE), 0, 1)], (1, 2, 1)),
    ],
    ids=["gem in glass", "bubble in glass", "glass over water", "water over glass", "weaker inside"],
)
def test_layers_that_are_all_but_smooth_pass_what_smooth_ones_do(things, indices):
    """(1 - T) / T = sum of R / (1 - R), within the 1 % of the tables of GGX."""
    assert h.mean_is(layered([*things, FLOOR], samples=128), incoherent(*indices), floor=0.01)


def test_layers_catch_rough_boundaries_with_the_vacuum(monkeypatch):
    monkeypatch.setattr(media, "around", media.vacuum)
    with pytest.raises(AssertionError):
        test_layers_that_are_all_but_smooth_pass_what_smooth_ones_do(
            [slab(0, 3, rough(1.5, FINE)), slab(1, 2, rough(2.4, FINE), side=3.0)], (1, 1.5, 2.4, 1.5, 1)
        )


def test_a_rough_boundary_between_equal_media_is_not_seen_but_what_is_behind_absorbs(monkeypatch):
    """Exactly exp(-0.7), whatever the roughness; from above, and by a camera in both."""
    monkeypatch.setattr(continuation, "ROULETTE_DEPTH", 10**6)
    things = [slab(0, 3, (OPEN,)), slab(1, 2, rough(1.5, COARSE), 0.7, side=3.0), FLOOR]
    assert needs.NESTED_MEDIA in Requirements.of(h.scene(things), h.settings())
    assert seen(things) == pytest.approx(np.exp(-0.7), rel=1e-3)
    camera = PerspectiveCamera.look_at((0.1, 0.2, 1.5), (0.1, 0.2, 0), up=(0, 1, 0), fov=1e-4)
    assert seen(things, camera) == pytest.approx(1.5**2 * np.exp(-0.35), rel=1e-3)


def test_what_is_not_seen_catches_rough_boundaries_with_the_vacuum(monkeypatch):
    monkeypatch.setattr(media, "around", media.vacuum)
    with pytest.raises(AssertionError):
        test_a_rough_boundary_between_equal_media_is_not_seen_but_what_is_behind_absorbs(monkeypatch)


def test_what_is_not_seen_catches_tables_of_boundaries_with_the_vacuum(monkeypatch):
    """Materials of bodies that share space are no tables of the cosine alone."""
    tabulated = compile.tabulated
    monkeypatch.setattr(compile, "tabulated", lambda materials, sharing: tabulated(materials))
    with pytest.raises(AssertionError):
        test_a_rough_boundary_between_equal_media_is_not_seen_but_what_is_behind_absorbs(monkeypatch)


def rough_heap(seed, roughness, absorption=0.0):
    """`heap` of bodies with rough boundaries, every other one smooth."""
    things, bodies = heap(seed, absorption=absorption)
    lobes = [rough(body[3], roughness) if i % 2 else thing.materials[0].lobes for i, (thing, body) in enumerate(zip(things, bodies))]
    return [h.replaced(o, materials=(h.replaced(o.materials[0], lobes=each),)) for o, each in zip(things, lobes)], bodies


def even_light(seed, roughness, is_inside):
    """Whether a heap in a white furnace looks white: from inside of a medium as bright as its index squared. Detects 3 %."""
    things, bodies = rough_heap(seed, roughness)
    eye = np.random.default_rng(seed + 100).uniform(-0.4, 0.4, 3)
    camera = PerspectiveCamera.look_at(eye, eye + np.array((0.3, 1.0, 0.2)), fov=1.5) if is_inside else OUTSIDE
    image = h.pixels(h.scene(things, camera=camera, world=1.0), h.settings(width=16, height=16, samples=64, max_depth=400))[1]
    return h.mean_is(image, index_at(eye, bodies) ** 2 if is_inside else 1.0, floor=1e-3)


@pytest.mark.parametrize("is_inside", [False, True])
@pytest.mark.parametrize(("seed", "roughness"), [(0, 0.1), (1, COARSE), (2, 0.7)])
def test_any_heap_of_rough_bodies_is_as_bright_as_what_surrounds_it(seed, roughness, is_inside):
    assert even_light(seed, roughness, is_inside)


def test_even_light_catches_rough_boundaries_with_the_vacuum(monkeypatch):
    """Smooth ones still know; seen from inside of media."""
    monkeypatch.setattr("glanz.engine.world.texturing.TexturePoints.around", np.float32(1))
    assert not all(even_light(seed, COARSE, True) for seed in range(3))


def test_even_light_catches_rough_bodies_without_media(monkeypatch):
    """As if only smooth boundaries had an index behind them."""
    monkeypatch.delattr(RoughRefraction, "ior")
    assert not all(even_light(seed, COARSE, True) for seed in range(3))


def lamp_in_a_ball(integrator):
    """A lamp in an absorbing rough ball in water: the light on a floor, (samples,)."""
    ball = Material(name="ball", lobes=rough(2.4, 0.8), medium=Medium(absorption=h.grey(3.0)))
    water = Material(name="water", lobes=(Dielectric(1.33),), medium=Medium(absorption=h.grey(0.2)))
    things = [
        h.thing(h.icosphere(2, 0.5, (0, 0, 1), smooth=True, name="ball"), ball),
        h.thing(h.box((-3, -3, -1), (3, 3, 3), name="water"), water),
        h.thing(h.quad((0, 0, 1), (0.3, 0, 0), (0, -0.3, 0)), GLOW),
        h.thing(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), h.lambert(0.8)),
    ]
    camera = OrthographicCamera(world_from_camera=h.affine(translation=(0, 0, 0.4)), window=(-0.4, 0.4, -0.4, 0.4))
    settings = h.settings(width=16, height=16, samples=128, max_depth=6, integrator=integrator)
    return h.pixels(h.scene(things, camera=camera), settings)[1].ravel()


def test_shadow_rays_find_through_rough_boundaries_what_scattered_rays_do():
    """Both estimators know which medium the light comes through. Detects 3 %."""
    assert h.means_agree(lamp_in_a_ball("path"), lamp_in_a_ball("path_blind"))


def test_agreement_catches_shadow_rays_in_the_medium_of_the_wrong_side(monkeypatch):
    leaving = direct.leaving

    def left_behind(plan, rays, *others):
        shadow = leaving(plan, rays, *others)
        shadow.carried.inside = rays.carried.inside
        return shadow

    monkeypatch.setattr(direct, "leaving", left_behind)
    with pytest.raises(AssertionError):
        test_shadow_rays_find_through_rough_boundaries_what_scattered_rays_do()


def test_how_the_work_is_cut_changes_no_bit_of_rough_media(monkeypatch):
    scene = h.scene(rough_heap(3, COARSE, absorption=0.2)[0], camera=OUTSIDE, world=1.0)
    settings = h.settings(width=16, height=12, samples=2, max_depth=12)
    reference = h.pixels(scene, settings)
    assert h.same_bits(h.pixels(scene, h.replaced(settings, threads=2, tile_size=5)), reference)
    monkeypatch.setattr(rendering, "LANES", 37)
    assert h.same_bits(h.pixels(scene, settings), reference)


def test_what_lies_in_water_reflects_as_in_water():
    """An opaque coat, which is no body itself: with a table of all its angles as without."""
    coat = GgxAlbedo(0.3, RelativeIndex(1.5), kind="dielectric")
    opaque = Material(name="coat", lobes=(Gloss(coat, 60.0),))
    water, cup = (Material(name=name, lobes=(Dielectric(ior),)) for name, ior in (("water", 1.33), ("cup", 1.5)))
    balls = [(0.5, opaque), (1.0, water), (1.1, cup)]
    things = [h.thing(h.icosphere(2, smooth=True), m, h.affine(r * np.eye(3))) for r, m in balls]
    scene = h.scene(things, camera=PerspectiveCamera.look_at((0, -0.8, 0), (0, 0, 0), fov=0.6), world=1.0)

    def colour():
        settings = h.settings(samples=1, passes=("Glossy Color",), max_depth=1)
        return render_image(scene, settings).passes["Glossy Color"].mean()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compile, "tabulated", lambda materials, around: (None, materials))
        expected = colour()
    assert colour() == pytest.approx(expected, rel=1e-4)
    assert expected < 0.03, "in air it would reflect 4 % and more"
