"""What is inside of bodies: absorption, and media in media (catalogue D9, D10, D13, A10)."""

import dataclasses
import itertools

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    CheckerTexture,
    Dielectric,
    Lens,
    Material,
    Medium,
    OrthographicCamera,
    PerspectiveCamera,
    PointLight,
    Requirements,
    needs,
)
from glanz.engine.constants import EPS32
from glanz.engine.wavefront import continuation, media
from glanz.engine.world.interaction import START_ULPS
from glanz.engine.world.media import Media
from glanz.engine.world.touching import moved_apart
from glanz.tests import chance, helpers as h

CLEAR = Dielectric(1.0)
"""A boundary that is there and does nothing: what is left of the light is Beer's law alone."""
OPEN = Dielectric(1.5, (0.0,) * 3, (1.0,) * 3, is_fresnel=False)
"""Glass that reflects nothing, so that no path is left to chance."""
NEAR = 2e-5
"""Rays start a little off their triangle, which they do not travel: half a millionth of its size and place."""
GROWN = 2e-4
"""Bodies that share space grow a few times as much."""
DOWN = PerspectiveCamera.look_at((0.1, 0.2, 9), (0.1, 0.2, 0), up=(0, 1, 0), fov=1e-4)
GLOW = Material(name="glow", emission=(1.0, 1.0, 1.0))
FLOOR = h.thing(h.quad((0, 0, -3), (900, 0, 0), (0, 900, 0), name="floor"), GLOW)


@pytest.fixture(autouse=True)
def no_roulette(monkeypatch):
    """Paths that are weak are followed to their end, so that what is left of them is exact."""
    monkeypatch.setattr(continuation, "ROULETTE_DEPTH", 10**6)


def body(low, high, absorption=0.0, priority=0, lobe=CLEAR, side=4.0, name="body"):
    """A wide box between the heights `low` and `high`, with a medium of its own."""
    material = Material(name=name, lobes=(lobe,), medium=Medium(absorption=h.grey(absorption), priority=priority))
    return h.thing(h.box((-side, -side, low), (side, side, high), name=name), material)


def seen(objects, camera=DOWN, lights=(), world=0.0, **settings):
    """The mean radiance (3,) of a picture of what is in the middle of it."""
    settings = {"width": 2, "height": 2, "samples": 1, "max_depth": 40} | settings
    return h.pixels(h.scene(objects, lights, camera, world), h.settings(**settings)).mean(axis=(1, 2), dtype=np.float64)


def incoherent(*indices):
    """Transmittance at normal incidence of layers of media: what (1 - T) / T of the boundaries adds up to."""
    share = [((a - b) / (a + b)) ** 2 for a, b in itertools.pairwise(indices)]
    return 1 / (1 + sum(r / (1 - r) for r in share))


# Beer's law


@pytest.mark.parametrize(("absorption", "expected"), [(0.0, 1.0), (1.0, 0.367879441), (1000.0, 0.0), (float("inf"), 0.0), (1e-30, 1.0)])
def test_absorption_follows_beers_law(absorption, expected):
    """D13, behind one metre."""
    assert seen([body(0, 1, absorption), FLOOR]) == pytest.approx(expected, rel=NEAR)


def test_absorption_catches_metres_taken_for_render_space(monkeypatch):
    of = Media.of
    monkeypatch.setattr(Media, "of", lambda bodies, row, material, owner, scale: of(bodies, row, material, owner, 1.0))
    with pytest.raises(AssertionError):
        test_absorption_follows_beers_law(1.0, 0.367879441)


def test_absorption_catches_nothing_times_infinity(monkeypatch):
    """D13: the plain formula makes NaN of it, which counts as black."""
    plain = lambda plan, inside, t: np.exp(-plan.world.media.absorption.take(media.strongest(inside), axis=1) * t)  # noqa: E731
    monkeypatch.setattr(media, "transmitted", plain)
    with pytest.raises(AssertionError):
        test_colours_that_are_not_absorbed_come_from_infinitely_far()


def test_colours_that_are_not_absorbed_come_from_infinitely_far():
    """A body without a bottom that absorbs red alone: the world behind it is seen in green and blue."""
    surface = h.thing(h.quad((0, 0, 1), (90, 0, 0), (0, 90, 0)), body(0, 1, (1.0, 0.0, 0.0)).materials[0])
    assert seen([surface], world=1.0) == pytest.approx((0, 1, 1))


def test_the_round_trips_catch_two_hundredths_less_absorption(monkeypatch):
    """D10, without chance."""
    monkeypatch.setattr(media, "transmitted", lambda plan, inside, t: np.full((3, t.size), 0.51, np.float32))
    with pytest.raises(AssertionError):
        test_whitted_adds_the_round_trips_in_a_slab_up_one_by_one(12, 6)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_absorption_counts_metres_at_every_scale(scale):
    material = Material(name="m", lobes=(CLEAR,), medium=Medium(absorption=(0.1 / scale, 1 / scale, 2 / scale)))
    thing = h.thing(h.box((-scale,) * 3, (scale,) * 3), material, h.affine(np.diag((3.0, 3.0, 0.5))))
    camera = PerspectiveCamera.look_at((0.1 * scale, 0.2 * scale, 9 * scale), (0.1 * scale, 0.2 * scale, 0), up=(0, 1, 0), fov=1e-4)
    assert seen([thing], camera, world=1.0) == pytest.approx(np.exp([-0.1, -1, -2]), rel=NEAR)


def test_a_ray_is_absorbed_along_its_refracted_way():
    """D13: at 60 degrees the way through glass is 1 / cos of 35.26, exp(-1.2247) = .293832656."""
    camera = PerspectiveCamera.look_at((np.tan(np.pi / 3) * 4, 0.2, 5), (0, 0.2, 1), up=(0, 1, 0), fov=1e-5)
    assert seen([body(0, 1, 1.0, lobe=OPEN), FLOOR], camera) == pytest.approx(0.293832656, rel=NEAR)


def slab_glass():
    return body(0, 1, np.log(2), lobe=Dielectric(1.5))


@pytest.mark.parametrize(("glow", "expected"), [(-3, 0.460984394), (12, 0.049219688)])
@chance.fresh
def test_a_slab_that_absorbs_half_passes_and_reflects_what_its_round_trips_add_up_to(glow, expected):
    """D10: T = (1 - R)^2 tau / (1 - R^2 tau^2), Rtot = R + (1 - R)^2 R tau^2 / (1 - R^2 tau^2); detects 0.6 % and 3 %."""
    lamp = h.thing(h.quad((0, 0, glow), (900, 0, 0), (0, 900, 0)), GLOW)
    scene = h.scene([slab_glass(), lamp], camera=DOWN)
    image = h.pixels(scene, h.settings(width=16, height=16, samples=1024, max_depth=50, sampler="random"))[1]
    assert h.mean_is(image, expected, floor=1e-5)


@pytest.mark.parametrize(("depth", "trips"), [(2, 1), (4, 2), (12, 6)])
def test_whitted_adds_the_round_trips_in_a_slab_up_one_by_one(depth, trips):
    """D10 without chance: T = (1 - R)^2 tau (1 + R^2 tau^2 + ...), each trip two bounces more."""
    again = (0.04 * 0.5) ** 2
    expected = 0.96**2 * 0.5 * sum(again**k for k in range(trips))
    image = seen([slab_glass(), FLOOR], max_depth=depth, integrator="whitted", min_contribution=0.0)
    assert image == pytest.approx(expected, rel=NEAR)
    if trips == 6:
        assert image == pytest.approx(0.460984394, rel=NEAR)


def test_the_way_to_lights_that_rays_run_into_is_absorbed():
    """The last metre of three, be it to an emissive mesh, to a light object, or to nowhere."""
    lamp = AreaLight(world_from_light=h.affine(np.diag((1, -1, -1)), (0, 0, -2)), size_x=90, size_y=90, radiance=(1.0,) * 3)
    glow = h.thing(h.quad((0, 0, -2), (90, 0, 0), (0, 90, 0)), GLOW)
    for objects, lights in (([glow], ()), ([], (lamp,))):
        assert seen([body(-5, 1, 1.0), *objects], lights=lights) == pytest.approx(np.exp(-3), rel=NEAR)
    # A body without a bottom: what is infinitely far away cannot be seen through it.
    surface = h.thing(h.quad((0, 0, 1), (90, 0, 0), (0, 90, 0)), body(0, 1, 1.0).materials[0])
    assert seen([surface], world=1.0) == pytest.approx(0)
    assert seen([h.replaced(surface, materials=body(0, 1, 0.0).materials)], world=1.0) == pytest.approx(1)


@pytest.mark.parametrize("integrator", ["path", "path_blind"])
@chance.fresh
def test_shadow_rays_are_absorbed(integrator):
    """A lamp, a matte floor and the camera in a body: the same light as in the vacuum, by exp of the way; detects 1 %."""
    lamp = h.thing(h.quad((0, 0, 3), (0.8, 0, 0), (0, -0.8, 0)), GLOW)
    camera = PerspectiveCamera.look_at((0, 1, 0.5), (0, 0, 0), fov=0.01)
    matte = h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)), h.lambert(1.0))
    settings = {"width": 16, "height": 16, "samples": 256, "max_depth": 0, "integrator": integrator}
    settings["max_depth"] = 0 if integrator == "path" else 1
    clear, weak = (
        h.pixels(h.scene([matte, lamp, *bodies], camera=camera), h.settings(**settings))[1] for bodies in ([], [body(-9, 9, 0.4)])
    )
    # The ways from the floor to the lamp are 3 to 3.06 m long.
    assert weak.mean() / clear.mean() == pytest.approx(np.exp(-0.4 * (np.hypot(1, 0.5) + 3.02)), rel=0.012)


def test_the_way_to_a_point_light_is_absorbed():
    """Exactly, with nothing left to chance: k_d / pi I / d^2 exp(-sigma (d + the way to the camera))."""
    light = PointLight(position=(0, 0, 2), intensity=(8.0,) * 3)
    camera = PerspectiveCamera.look_at((0, 0, 1), (0, 0, 0), up=(0, 1, 0), fov=1e-4)
    matte = h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)), h.lambert(1.0))
    image = seen([matte, body(-5, 5, (0.1, 1.0, 2.0))], camera, [light], max_depth=0)
    assert image == pytest.approx(2 / np.pi * np.exp(-3 * np.array([0.1, 1.0, 2.0])), rel=NEAR)


# Where the camera is


CAMERAS = {
    "pinhole": PerspectiveCamera.look_at((0.1, 0.2, 1), (0.1, 0.2, 0), up=(0, 1, 0), fov=1e-4),
    "lens": PerspectiveCamera.look_at((0.1, 0.2, 1), (0.1, 0.2, 0), up=(0, 1, 0), fov=1e-4, lens=Lens(radius=0.001)),
    "orthographic": OrthographicCamera(world_from_camera=h.affine(translation=(0.1, 0.2, 1)), window=(-0.05, 0.05, -0.05, 0.05)),
}


@pytest.mark.parametrize("name", CAMERAS)
@pytest.mark.parametrize(("bodies", "way"), [([(-1, 5)], 2), ([(-1, 0.5)], 1.5), ([(2, 3)], 0), ([(-5, 5), (-1, 2)], 0)], ids=str)
def test_a_camera_may_be_inside_of_bodies(name, bodies, way):
    """One metre above the ground: in a body, above it, below it, in two at once, of which the inner is clear."""
    things = [body(*heights, 0.0 if i else 1.0, side=4 - i, name=f"{i}") for i, heights in enumerate(bodies)]
    way += 2 if len(bodies) > 1 else 0
    assert seen([*things, FLOOR], CAMERAS[name]) == pytest.approx(np.exp(-way), rel=2e-4)


def test_each_ray_of_a_wide_camera_starts_where_it_does():
    """The left half of the rays in a body, the right half beside it."""
    thing = h.thing(h.box((-90, -90, -90), (0, 90, 90)), body(0, 1, 1.0).materials[0])
    camera = OrthographicCamera(world_from_camera=h.affine(translation=(0, 0, 0)), window=(-0.5, 0.5, -0.25, 0.25))
    image = h.pixels(h.scene([thing, FLOOR], camera=camera), h.settings(width=2, height=1, samples=4))[1]
    assert image[0] == pytest.approx([np.exp(-3), 1], rel=NEAR)


# Media in media


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize(("glass", "water", "expected"), [(1, 0, 0.3 * 2 + 0.7), (0, 1, 0.3 + 0.7 * 2), (0, 0, 0.3 * 2 + 0.7)])
def test_the_higher_priority_is_there_where_bodies_overlap(glass, water, expected, order):
    """Glass from 0 to 2 and water from 1 to 3, seen from above and from below; of equal ones the smaller body is there."""
    things = [body(0, 2, 0.3, glass, side=3.0), body(1, 3, 0.7, water)]
    camera = DOWN if order > 0 else PerspectiveCamera.look_at((0.1, 0.2, -2), (0.1, 0.2, 0), up=(0, 1, 0), fov=1e-4)
    assert seen(things[::order], camera, world=1.0) == pytest.approx(np.exp(-expected), rel=GROWN)


def layered(things, samples=512, world=1.0):
    scene = h.scene(things, camera=DOWN)
    return h.pixels(scene, h.settings(width=16, height=16, samples=samples, max_depth=60, sampler="random"))[1]


@pytest.mark.parametrize(
    ("things", "indices"),
    [
        ([body(0, 3, lobe=Dielectric(1.5)), body(1, 2, lobe=Dielectric(2.4), side=3.0)], (1, 1.5, 2.4, 1.5, 1)),
        ([body(0, 3, lobe=Dielectric(2.0)), body(1, 2, lobe=Dielectric(1.0), side=3.0)], (1, 2, 1, 2, 1)),
        ([body(0, 2, 0, 1, lobe=Dielectric(2.4)), body(1, 3, lobe=Dielectric(1.33))], (1, 2.4, 1.33, 1)),
        ([body(0, 2, 0, 0, lobe=Dielectric(2.4)), body(1, 3, 0, 1, lobe=Dielectric(1.33))], (1, 2.4, 1.33, 1)),
        ([body(0, 2, lobe=Dielectric(2.4)), body(1, 3, lobe=Dielectric(2.4), name="other")], (1, 2.4, 1)),
        ([body(0, 4, 0, 2, lobe=Dielectric(2.0)), body(1, 2, 0, 1, lobe=Dielectric(1.2))], (1, 2, 1)),
    ],
    ids=["gem in glass", "bubble in glass", "glass over water", "water over glass", "glass in glass", "weaker inside"],
)
@chance.fresh
def test_layers_pass_what_their_boundaries_add_up_to(things, indices):
    """D9 for any number of layers: (1 - T) / T = sum of R / (1 - R); detects 1.5 %."""
    image = layered([*things, FLOOR])
    assert h.mean_is(image, incoherent(*indices), floor=1e-5)
    assert not h.mean_is(1.015 * image, incoherent(*indices), floor=1e-5)


@pytest.mark.parametrize("glass", [-1, 0, 1])
@chance.fresh
def test_bodies_that_touch_pass_what_their_boundaries_add_up_to(glass):
    """Water that fits its glass, lid and floor: faces that coincide are one boundary, whichever of the two a ray meets."""
    water = body(1, 2, lobe=Dielectric(1.33), name="water")
    wall = [body(*z, 0, glass, lobe=Dielectric(2.4), name=f"{z}") for z in ((0, 1), (2, 3))]
    assert h.mean_is(layered([*wall, water, FLOOR]), incoherent(1, 2.4, 1.33, 2.4, 1), floor=1e-5)
    absorbing = [body(*z, a, glass * (a < 1), name=f"{z}") for z, a in (((0, 1), 0.3), ((1, 2), 1.0), ((2, 3), 0.3))]
    for order in (1, -1):
        assert seen([*absorbing[::order], FLOOR]) == pytest.approx(np.exp(-1.6), rel=GROWN)


def test_the_sum_catches_touching_bodies_that_are_not_moved_apart(monkeypatch):
    monkeypatch.setattr("glanz.engine.world.compile.moved_apart", lambda vertices, *others: vertices)
    with pytest.raises(AssertionError):
        test_bodies_that_touch_pass_what_their_boundaries_add_up_to(1)


@pytest.mark.parametrize("shared", [True, False])
def test_bodies_that_share_space_grow_and_stay_closed(shared):
    """Outwards by a few times what rays start off a face, the stronger more, and corners in one place together."""
    mesh = h.box((-1, -1, -1), (1, 1, 1))
    corners = mesh.triangles.ravel()
    if not shared:
        mesh = dataclasses.replace(mesh, vertices=mesh.vertices[:, corners], triangles=np.arange(36).reshape(3, 12))
    start = START_ULPS * EPS32 * (1 + 2)
    for layer in (1, 3):
        grown = moved_apart(mesh.vertices.astype(np.float32), mesh.triangles, np.zeros(12, int), np.full(12, layer)).astype(np.float64)
        out = np.abs(grown).min(axis=0) - 1
        assert (out > layer * start * 1.6).all()
        assert (out < layer * start * 4.1).all()
        assert len(np.unique(grown, axis=1).T) == 8
    assert moved_apart(mesh.vertices, mesh.triangles, np.zeros(12, int), np.zeros(12, int)) is mesh.vertices


def test_whitted_passes_layers_without_chance():
    """A bubble in glass, to 1e-4: what is left out counts less than a millionth at each split."""
    things = [body(0, 3, lobe=Dielectric(1.5)), body(1, 2, lobe=Dielectric(1.0), side=3.0), FLOOR]
    image = seen(things, max_depth=40, integrator="whitted", min_contribution=1e-7)
    assert image == pytest.approx(incoherent(1, 1.5, 1, 1.5, 1), rel=1e-4)


def test_the_sum_catches_boundaries_with_the_vacuum(monkeypatch):
    """What a boundary would be if nobody asked what is around."""
    monkeypatch.setattr(media, "relative_indices", lambda plan, rays, surface, reflection: reflection)
    with pytest.raises(AssertionError):
        test_layers_pass_what_their_boundaries_add_up_to(
            [body(0, 3, lobe=Dielectric(1.5)), body(1, 2, lobe=Dielectric(2.4), side=3.0)], (1, 1.5, 2.4, 1.5, 1)
        )


def spheres_in(outer, inner):
    """A glass ball on a striped floor, and what is inside of it."""
    floors = [h.thing(h.quad((i, 0, -1), (0.5, 0, 0), (0, 20, 0), name=f"{i}"), GLOW) for i in range(-9, 9)]
    camera = PerspectiveCamera.look_at((0.1, -4, 2), (0, 0, 0), fov=0.6)
    return h.scene([outer, *inner, *floors], camera=camera)


def ball(radius, ior, priority=0, name="ball", centre=(0, 0, 0)):
    material = Material(name=name, lobes=(Dielectric(ior),), medium=Medium(priority=priority))
    return h.thing(h.icosphere(3, radius, centre, smooth=True, name=name), material)


BALL_SETTINGS = h.settings(width=24, height=24, samples=16, max_depth=12)


def shell():
    """A hollow ball as one mesh: what a bubble in glass is without any media."""
    outer, inner = h.icosphere(3, 1.0, smooth=True), h.icosphere(3, 0.6, smooth=True)
    count = outer.vertices.shape[1]
    mesh = h.Mesh(
        name="shell",
        vertices=np.concatenate((outer.vertices, inner.vertices), axis=1),
        triangles=np.concatenate((outer.triangles, inner.triangles[::-1] + count), axis=1),
        normals=np.concatenate((outer.normals, -inner.normals), axis=1),
        normal_indices=np.concatenate((outer.normal_indices, inner.normal_indices[::-1] + count), axis=1),
    )
    return h.thing(mesh, Material(name="glass", lobes=(Dielectric(1.5),)))


def alike(a, b):
    """Whether two pictures agree but for a few paths that rounding has sent elsewhere."""
    return np.mean(np.abs(a - b) > 1e-3) <= 0.02 and np.abs(a.mean() / b.mean() - 1) <= 2e-3


def test_a_bubble_in_glass_is_a_hollow_ball():
    """The same paths through a ball of vacuum in glass and through a mesh with a cavity, which needs no media."""
    bubble, hollow = spheres_in(ball(1.0, 1.5), [ball(0.6, 1.0, name="bubble")]), spheres_in(shell(), [])
    assert needs.NESTED_MEDIA not in Requirements.of(hollow, BALL_SETTINGS)
    assert alike(h.pixels(bubble, BALL_SETTINGS), h.pixels(hollow, BALL_SETTINGS))
    assert not alike(h.pixels(spheres_in(ball(1.0, 1.5), []), BALL_SETTINGS), h.pixels(hollow, BALL_SETTINGS))


def test_what_is_weaker_than_its_surroundings_is_not_there():
    """Balls of anything inside of a ball of glass, or across its surface, cut away; also for shadow rays and the depth."""
    weak = [ball(0.5, 2.4, -1, "a"), ball(0.3, 1.2, -2, "b", (0.2, 0, 0)), ball(0.25, 1.0, -1, "c", (0, 0, 0))]
    with_lamp = {"lights": [PointLight(position=(0, 0, 0.75), intensity=(3.0,) * 3)]}
    matte = h.thing(h.icosphere(1, 0.2, (0.1, 0, -0.3), name="matte"), h.lambert(0.7))
    settings = h.replaced(BALL_SETTINGS, max_depth=3, passes=("Combined", "Depth"))
    alone, filled = (h.replaced(spheres_in(ball(1.0, 1.5), [matte, *more]), **with_lamp) for more in ([], weak))
    assert alike(h.pixels(alone, settings), h.pixels(filled, settings))


def test_likeness_catches_weaker_bodies_that_are_there(monkeypatch):
    monkeypatch.setattr(media, "through_media", lambda closest: closest)
    with pytest.raises(AssertionError):
        test_what_is_weaker_than_its_surroundings_is_not_there()


def test_likeness_catches_shadow_rays_that_weaker_bodies_stop(monkeypatch):
    monkeypatch.setattr(media, "occluded_in_media", lambda occluded, closest: occluded)
    with pytest.raises(AssertionError):
        test_what_is_weaker_than_its_surroundings_is_not_there()


@pytest.mark.parametrize("precision", ["fast", "exact"])
def test_a_thin_pane_is_two_boundaries(precision):
    """A10: a millionth of the distance thick, with and without media around; each ray passes exactly two."""
    camera = PerspectiveCamera.look_at((0.1, 0.2, 1), (0, 0, 0), up=(0, 1, 0), fov=0.4)
    for more in ([], [body(-5, 5, 0.0, -1, side=6.0, name="around")]):
        for scale in (1e-3, 1, 1e3):
            things = [body(0, 1e-6, 0.5, lobe=OPEN, side=0.5), *more]
            small = [h.replaced(o, world_from_object=scale * o.world_from_object) for o in things]
            eye = h.replaced(camera, world_from_camera=h.affine(camera.world_from_camera[:3, :3], scale * camera.world_from_camera[:3, 3]))
            plan = h.plan_of(h.scene(small, camera=eye, world=1.0), h.settings(max_depth=10, samples=1, precision=precision))
            passed = []
            count = lambda plan, rays, surface, reflection, scattered, passed=passed: passed.append(rays.slot)  # noqa: E731
            h.pixels_of_plan(dataclasses.replace(plan, on_leaving=(*plan.on_leaving, count)))
            assert np.bincount(np.concatenate(passed)).tolist() == [2 + len(more)] * 64


@pytest.mark.parametrize("precision", ["fast", "exact"])
def test_two_boundaries_catch_rays_that_start_too_far_off(monkeypatch, precision):
    monkeypatch.setattr("glanz.engine.world.interaction.START_ULPS", 100)
    with pytest.raises(AssertionError):
        test_a_thin_pane_is_two_boundaries(precision)


def test_a_part_in_another_glass_closes_the_same_body():
    """A box with sides of one glass and ends of another: one body, that absorbs what the first of them says."""
    ends = Material(name="ends", lobes=(CLEAR,))
    mesh = dataclasses.replace(h.box((-9, -9, 0), (9, 9, 1)), material_indices=[0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0])
    upper = np.argwhere(np.isin(mesh.triangles, (1, 3, 5, 7)).all(axis=0)).ravel()
    mesh = dataclasses.replace(mesh, material_indices=np.isin(np.arange(12), upper).astype(int))
    thing = h.Object(name="two", mesh=mesh, materials=(body(0, 1, 1.0).materials[0], ends))
    assert seen([thing, FLOOR]) == pytest.approx(np.exp(-1), rel=NEAR)


def test_the_index_of_a_boundary_may_be_a_texture():
    """Glass whose texture is 1.2 where rays meet it, and 1.8 on average, and another body in it: T = 2 n / (n^2 + 1); detects 0.5 %."""
    pane = body(0, 1, lobe=Dielectric(CheckerTexture(even=(1.2,) * 3, odd=(2.4,) * 3)), name="pane")
    inner = h.thing(h.box((3, 3, 0.2), (3.5, 3.5, 0.8), name="inner"), Material(name="inner", lobes=(Dielectric(1.3),)))
    assert needs.NESTED_MEDIA in Requirements.of(h.scene([pane, inner]), h.settings())
    assert h.mean_is(layered([pane, inner, FLOOR]), 2.4 / 2.44, floor=1e-4)
