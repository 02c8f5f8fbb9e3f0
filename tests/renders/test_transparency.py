"""Light through transparent surfaces: what arrives is the product of what they let pass, whoever looks for it."""

import math

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    Dielectric,
    Lambert,
    LambertTransmission,
    LinearTexture,
    Material,
    PerspectiveCamera,
    PointLight,
    SunLight,
    Transparent,
    World,
    render_image,
)
from glanz.engine.integrators.path import Path
from glanz.engine.wavefront import passing
from glanz.tests import chance, helpers as h

TINT = np.array((0.9, 0.5, 0.25))
SQUARE = 0.752274688
"""Irradiance of a unit square of radiance 1 at distance 1, overhead (catalogue E4)."""
OVERHEAD = h.affine(np.eye(3), (0, 0, 1))
GLOW = h.lambert(0, "glow", 1.0)
LIGHTS = {
    "point": ([PointLight(position=(0.0, 0.0, 2.0), intensity=(4.0,) * 3)], [], 1.0),
    "sun": ([SunLight(towards=(0.6, 0.0, 0.8))], [], 0.8),
    "wide sun": ([SunLight(towards=(0.6, 0.0, 0.8), angle=0.5)], [], 0.8),
    "area": ([AreaLight(world_from_light=OVERHEAD)], [], SQUARE),
    "mesh": ([], [h.thing(h.quad((0, 0, 1)), GLOW)], SQUARE),
    "two kinds": ([SunLight(towards=(0.6, 0.0, 0.8))], [h.thing(h.quad((0, 0, 1)), GLOW)], 0.8 + SQUARE),
}


def clear(transmittance, *lobes, emission=0.0, name="clear"):
    return Material(name=name, lobes=(Transparent(h.grey(transmittance)), *lobes), emission=h.grey(emission))


def sheets(count, material, low=0.6, high=0.9, size=200.0):
    """Level sheets at heights from `low` to `high`, a little askew."""
    heights = np.linspace(low, high, count)
    return [h.thing(h.quad((0.1, 0.2, z), (size, 0, 0.03 * z), (0, size, 0.02), name=f"sheet {z}"), material) for z in heights]


def below(lights, objects, world=0.0):
    """A white patch, seen from below all sheets."""
    return h.replaced(h.receiver(lights, objects, distance=0.3, tilt=0.5), world=World(radiance=h.grey(world)))


def irradiance(scene, **changes):
    """(3, 64) [W m^-2]: of direct light on the patch, pixel by pixel."""
    image = h.pixels(scene, h.settings(**{"max_depth": 0, "samples": 64, **changes}))
    return image.reshape(3, -1).astype(np.float64) * math.pi


def is_weakened(values, truth):
    """Whether the channels of `values` have the means `truth` (3,)."""
    return all(h.mean_is(channel, E, floor=1e-5, absolute=1e-9) for channel, E in zip(values, truth, strict=True))


WAYS = [(name, "path") for name in LIGHTS]
WAYS += [(name, way) for name in ("area", "mesh", "wide sun") for way in ("path_blind", "path_naive")]
WAYS += [("point", "whitted"), ("sun", "whitted"), ("point", "distributed"), ("area", "distributed")]
"""Light without a size is found by shadow rays alone."""


@pytest.mark.parametrize("count", [0, 1, 3])
@pytest.mark.parametrize(("name", "integrator"), WAYS)
def test_k_sheets_leave_the_kth_power_of_their_transmittance(name, count, integrator):
    """tau^k E, coloured, under every kind of light; askew, sheets are met at all angles and count once each.

    Detects 3 %, and 10 % of a sun that scattered rays have to find.
    """
    lights, objects, E = LIGHTS[name]
    scene = below(lights, [*objects, *sheets(count, clear(TINT), 0.6, 0.75, 40.0)])
    values = irradiance(scene, integrator=integrator, samples=64 if integrator == "path" else 400)
    assert is_weakened(values, TINT**count * E)
    noticed = 1.1 if name == "wide sun" and integrator != "path" else 1.03
    assert not is_weakened(noticed * values, TINT**count * E)


@pytest.mark.parametrize("integrator", ["path", "path_naive"])
def test_the_world_shines_through_boxes_in_boxes(integrator):
    boxes = [h.thing(h.box((-s,) * 3, (s,) * 3, name=f"box {s}"), clear(TINT)) for s in (1.0, 1.1, 2.0)]
    assert is_weakened(irradiance(below([], boxes, world=1.0), integrator=integrator), math.pi * TINT**3)


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1.0, 1e6])
@pytest.mark.parametrize("gap", [1e-5, 1e-2])
def test_sheets_count_once_each_at_every_scale(scale, gap):
    """Close ones too: the gap is `gap` of their height. Sharp light, so every pixel has to be right."""
    light = PointLight(position=(0.0, 0.0, 2.0 * scale), intensity=(4.0 * scale**2,) * 3)
    stack = [h.thing(h.quad((0, 0, scale * (0.6 + i * gap)), (scale, 0, 0), (0, scale, 0), name=f"{i}"), clear(TINT)) for i in range(5)]
    scene = h.receiver([light], stack, size=0.01 * scale, distance=0.3 * scale, tilt=0.5)
    values = irradiance(scene, samples=2)
    np.testing.assert_allclose(values, np.broadcast_to((TINT**5)[:, None], values.shape), rtol=2e-5)


def test_a_window_does_not_shadow_the_small_lamp_behind_it():
    """Where rays start anew depends on the window's size, where they end on the lamp's: the end must not reach the lamp."""
    lamp = h.thing(h.quad((0, 0, 1), (1e-4, 0, 0), (0, 0.2e-4, 1e-4), name="lamp"), h.lambert(0, "glow", 1e8))
    pane = h.thing(h.quad((300, 0, 15.5), (1000, 0, 50), (0, 1000, 0), name="pane"), clear(0.5))
    lit, behind = (irradiance(below([], [lamp, *panes])).mean() for panes in ([], [pane]))
    assert behind == pytest.approx(0.5 * lit, rel=1e-3)


def test_windows_catch_rays_that_are_not_aimed_anew(monkeypatch):
    monkeypatch.setattr(passing, "_aimed", lambda gone, d, limit: (d, limit - np.einsum("in,in->n", gone, d)))
    with pytest.raises(AssertionError):
        test_a_window_does_not_shadow_the_small_lamp_behind_it()


def test_a_surface_that_lets_nothing_pass_is_opaque_to_the_bit():
    lights, objects, _ = LIGHTS["area"]
    dark, opaque = (
        below(lights, [*objects, *sheets(2, Material(name="m", lobes=lobes), size=0.3)], world=0.3)
        for lobes in ((Transparent((0.0,) * 3), Lambert((0.5,) * 3)), (Lambert((0.5,) * 3),))
    )
    settings = h.settings(max_depth=3)
    assert h.same_bits(h.pixels(dark, settings), h.pixels(opaque, settings))


def test_a_surface_that_lets_all_pass_is_not_there():
    """But for the rounding of points where rays start anew."""
    lights, objects, _ = LIGHTS["two kinds"]
    room = [*objects, h.thing(h.box((-3, -3, -1), (3, 3, 4)), h.lambert((0.5, 0.6, 0.7)))]
    empty, glazed = (h.pixels(below(lights, [*room, *panes]), h.settings(max_depth=4)) for panes in ([], sheets(3, clear(1.0), 0.1, 0.9)))
    assert glazed.mean() == pytest.approx(empty.mean(), rel=1e-3)
    assert (np.abs(glazed - empty) <= 1e-4 * empty).mean() > 0.95


def looking_down(objects, lights=(), world=0.0, **camera):
    return h.scene(objects, lights, PerspectiveCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0), fov=0.02, **camera), world)


def seen(scene, **changes):
    """(3, 64) radiance."""
    return h.pixels(scene, h.settings(**changes)).reshape(3, -1).astype(np.float64)


def test_a_card_shows_itself_and_what_is_behind_it():
    """alpha C + (1 - alpha) B: the mean of both for 0.5."""
    card = h.thing(h.quad((0, 0, 1)), clear(0.5, Lambert((0.5 * 0.6,) * 3)))
    values = seen(looking_down([card], [SunLight()], world=0.25), samples=256, max_depth=0)
    # The world shines on the card from above and from below; what it reflects upwards comes from above.
    assert h.mean_is(values[0], 0.3 * (1 / math.pi + 0.25) + 0.5 * 0.25, floor=1e-6)


def test_whitteds_rays_follow_what_a_card_reflects_and_what_it_lets_pass():
    """Without a random number, so without noise; the world does not shine on dull surfaces."""
    card = h.thing(h.quad((0, 0, 1)), clear(0.5, Lambert((0.5 * 0.6,) * 3)))
    values = seen(looking_down([card], [SunLight()], world=0.25), samples=1, integrator="whitted")
    np.testing.assert_allclose(values, 0.3 / math.pi + 0.5 * 0.25, rtol=1e-6)


def test_what_glows_behind_what_glows_adds_up_in_every_sample():
    """E1 + tau1 (E2 + tau2 B), with no number drawn."""
    stack = [h.thing(h.quad((0, 0, z), name=f"{z}"), clear(TINT, emission=E)) for z, E in ((1, 0.25), (2, 4.0))]
    values = seen(looking_down(stack, world=2.0), samples=1)
    np.testing.assert_allclose(values, np.broadcast_to((4 + TINT * (0.25 + TINT * 2))[:, None], values.shape), rtol=1e-6)


def test_lamps_before_between_and_behind_sheets_are_seen_once_each():
    """Light objects hide nothing, so one ray meets them all; what stands before a sheet is not weakened by it."""
    upwards = h.frame_towards((0, 0, -1))
    lamps = [
        AreaLight(name=f"{z}", world_from_light=h.affine(upwards, (0, 0, z)), radiance=(L,) * 3, is_visible=True)
        for z, L in ((3.5, 1.0), (1.5, 8.0), (-0.5, 64.0))
    ]
    stack = [h.thing(h.quad((0, 0, z), (3, 0, 0), (0, 3, 0), name=f"{z}"), clear(TINT)) for z in (1.0, 2.0)]
    values = seen(looking_down(stack, lamps), samples=1)
    np.testing.assert_allclose(values, np.broadcast_to((1 + 8 * TINT + 64 * TINT**2)[:, None], values.shape), rtol=1e-6)


def furnace(lobes, world=1.0, **changes):
    """A sphere of `lobes` in even light."""
    sphere = h.thing(h.icosphere(2), Material(name="sphere", lobes=lobes))
    camera = PerspectiveCamera.look_at((0.1, -4, 0.3), (0, 0, 0), fov=0.6)
    scene = h.scene([sphere], camera=camera, world=world)
    return h.pixels(scene, h.settings(**{"width": 24, "height": 24, "samples": 64, "max_depth": 100, **changes})).reshape(3, -1)


@pytest.mark.parametrize("sampler", ["stratified", "sobol", "blue_noise"])
@chance.fresh
def test_what_loses_nothing_is_as_bright_as_what_surrounds_it(sampler):
    """Whichever share of each channel passes and whichever is reflected; detects 0.5 %."""
    passing_share = np.array((0.5, 0.9, 0.1))
    image = furnace((Transparent(tuple(passing_share)), Lambert(tuple(1 - passing_share))), sampler=sampler)
    assert all(h.mean_is(channel, 1.0, floor=1e-6) for channel in image)


def test_what_a_texture_lets_pass_is_taken_from_lobes_without_textures():
    """Half of the light passes, so that half is left for the other lobe; without textures such a material is refused."""
    image = furnace((Transparent(LinearTexture((), (), (0.5, 0.5, 0.5))), Lambert((0.8, 0.8, 0.8))), samples=4)
    assert np.abs(image - 1).max() <= 1e-5


def test_a_filter_alone_draws_no_number_and_has_no_noise():
    """Through front and back of a sphere: tau^2, in every sample that meets it."""
    image = furnace((Transparent(tuple(TINT)),), world=1.0)
    inside = np.abs(image[0] - TINT[0] ** 2) <= 1e-5
    assert inside.mean() > 0.3
    assert np.abs(image[:, inside] - (TINT**2)[:, None]).max() <= 1e-5


@pytest.mark.parametrize("tints", [False, True])
def test_glass_blocks_shadow_rays_unless_the_integrator_has_them_weakened(monkeypatch, tints):
    """The lecture's semi-transparent surfaces: k_t each time, straight on, whatever the index of refraction."""
    monkeypatch.setattr(Path, "tints_glass", tints)
    ball = h.thing(h.icosphere(2, 0.25, (0, 0, 1)), Material(name="glass", lobes=(Dielectric(1.5, transmittance=tuple(TINT)),)))
    lights, _, E = LIGHTS["point"]
    values = irradiance(below(lights, [ball]), samples=1)
    np.testing.assert_allclose(values, np.broadcast_to(tints * E * TINT[:, None] ** 2, values.shape), rtol=1e-5)


@pytest.mark.parametrize("integrator", ["path", "whitted"])
def test_translucent_sheets_block_shadow_rays(integrator):
    """What passes them is spread, and found by scattered rays."""
    sheet = sheets(1, Material(name="paper", lobes=(LambertTransmission((0.5, 0.5, 0.5)),)))
    assert not irradiance(below(LIGHTS["point"][0], sheet), samples=1, integrator=integrator).any()


def test_crossed_filters_are_black():
    """And nothing else: not the 0 / 0 of a path that nothing is left of."""
    stack = [h.thing(h.quad((0, 0, z), name=f"{z}"), clear(tint)) for z, tint in ((1, (1.0, 0.0, 0.0)), (2, (0.0, 0.5, 1.0)))]
    values = seen(looking_down(stack, world=1.0), samples=2)
    assert not values.any()


@pytest.mark.parametrize("most", [0, 2, 3, 64])
def test_the_next_surface_after_the_last_one_absorbs(most):
    """`max_transparent`, for shadow rays, scattered rays and camera rays alike."""
    expected = TINT**3 if most >= 3 else 0 * TINT
    for integrator in ("path", "path_naive"):
        scene = below([], [h.thing(h.quad((0, 0, 1)), GLOW), *sheets(3, clear(TINT), 0.6, 0.75)])
        assert is_weakened(irradiance(scene, integrator=integrator, max_transparent=most, samples=100), expected * SQUARE)
    stack = [h.thing(h.quad((0, 0, z), name=f"{z}"), clear(TINT)) for z in (1, 2, 3)]
    values = seen(looking_down(stack, world=1.0), samples=1, max_transparent=most)
    np.testing.assert_allclose(values, np.broadcast_to(expected[:, None], values.shape), rtol=1e-6)


def test_passes_record_the_surface_where_the_path_stays():
    pane = h.thing(h.quad((0, 0, 3), (2, 0, 1), (0, 2, 0), name="pane"), clear(0.5))
    floor = h.thing(h.quad((0, 0, 1), name="floor"), h.lambert())
    passes = render_image(looking_down([pane, floor]), h.settings(passes=("Combined", "Depth", "Normal"))).passes
    np.testing.assert_allclose(passes["Depth"], 4.0, rtol=1e-6)
    np.testing.assert_allclose(passes["Normal"], np.broadcast_to((0, 0, 1.0), passes["Normal"].shape), atol=1e-6)


@pytest.mark.parametrize(("end", "expected"), [(3.9, 0.25), (4.1, 1.0)])
def test_the_clip_range_is_measured_from_the_camera(end, expected):
    """Rays that start anew behind a pane have only the rest of it left."""
    pane = h.thing(h.quad((0, 0, 3), (2, 0, 1), (0, 2, 0), name="pane"), clear(1.0))
    wall = h.thing(h.quad((0, 0, 1), name="wall"), h.lambert(0, "glow", 1.0))
    values = seen(looking_down([pane, wall], world=0.25, clip_end=end), samples=1)
    np.testing.assert_allclose(values, expected, rtol=1e-6)


# Mutants


def _travels_with(monkeypatch, change):
    travel_beyond = passing._travel_beyond

    def changed(plan, rays, hits, film):
        return change(plan, rays, hits, film, travel_beyond)

    monkeypatch.setattr(passing, "_travel_beyond", changed)


def test_powers_catch_transmittance_that_counts_twice(monkeypatch):
    transmittance = passing._transmittance
    monkeypatch.setattr(passing, "_transmittance", lambda *args: transmittance(*args) ** 2)
    for name in ("point", "sun", "area", "mesh"):
        with pytest.raises(AssertionError):
            test_k_sheets_leave_the_kth_power_of_their_transmittance(name, 1, "path")


def test_powers_catch_a_density_that_is_forgotten_at_a_sheet(monkeypatch):
    """Light found beyond would no longer be shared with shadow rays."""
    _travels_with(monkeypatch, lambda plan, rays, hits, film, go: go(plan, h.replaced(rays, pdf=rays.pdf * np.inf), hits, film))
    for name in ("area", "mesh", "wide sun"):
        with pytest.raises(AssertionError):
            test_k_sheets_leave_the_kth_power_of_their_transmittance(name, 1, "path")


def test_powers_catch_distances_measured_from_the_last_sheet(monkeypatch):
    dot = passing.dot

    def from_the_last_sheet(plan, rays, hits, film, go):
        with monkeypatch.context() as patch:
            patch.setattr(passing, "dot", lambda a, b: 0 * dot(a, b))
            return go(plan, rays, hits, film)

    _travels_with(monkeypatch, from_the_last_sheet)
    with pytest.raises(AssertionError):
        test_k_sheets_leave_the_kth_power_of_their_transmittance("mesh", 1, "path")
    with pytest.raises(AssertionError):
        test_the_clip_range_is_measured_from_the_camera(3.9, 0.25)


def test_lamps_catch_rays_that_see_again_what_is_behind_them(monkeypatch):
    def from_the_start(plan, rays, hits, film, go):
        return go(plan, rays, h.replaced(hits, t=0 * hits.t), film)

    _travels_with(monkeypatch, from_the_start)
    with pytest.raises(AssertionError):
        test_lamps_before_between_and_behind_sheets_are_seen_once_each()


def test_the_furnace_catches_a_decision_that_is_not_paid_for(monkeypatch):
    def unpaid(plan, rays, hits, turn):
        beta = rays.beta.copy()
        on = decide(plan, rays, hits, turn)
        rays.beta[...] = beta
        return on

    decide = passing._decide
    monkeypatch.setattr(passing, "_decide", unpaid)
    with pytest.raises(AssertionError):
        test_a_card_shows_itself_and_what_is_behind_it()
