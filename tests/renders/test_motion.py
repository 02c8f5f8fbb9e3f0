"""What moves is spread over the time that the shutter is open (catalogue G5, G6, G7), by closed forms and by counter-motion."""

import math

import numpy as np
import pytest

from glanz.engine import Dielectric, Lens, Material, Medium, Mesh, OrthographicCamera, PanoramaCamera, PerspectiveCamera, SunLight
from glanz.engine.arrays import Columns
from glanz.engine.maths.poses import Keys
from glanz.engine.wavefront import motion
from glanz.engine.world.poses import Poses
from glanz.tests import chance, helpers as h, scenes
from glanz.tests.moving import GLOW, from_above, is_share, moving, shifted, trapezoid, turned

# G5: a bar


def bar(travel, samples):
    """A glowing bar of width 1 that travels from left to right, seen from above: pixels (W,) of one row, and their places (W,)."""
    reach = 0.5 * (1 + travel) * 1.25
    thing = h.replaced(h.thing(h.quad(y=(0, 20 * reach, 0)), GLOW), motion=shifted((-travel / 2, 0, 0), (travel / 2, 0, 0)))
    settings = h.settings(width=80, height=1, samples=samples, sampler="random")
    row = h.pixels(h.scene([thing], camera=from_above(2 * reach)), settings)[0, 0].astype(np.float64)
    return row, (np.arange(80) + 0.5) / 80 * 2 * reach - reach


def check_trapezoid(travel=3.0, samples=1024):
    """Every pixel; returns them, their truth and their width."""
    row, x = bar(travel, samples)
    truth = trapezoid(x, travel, x[1] - x[0])
    assert is_share(row, truth, samples)
    return row, truth, x[1] - x[0]


@pytest.mark.parametrize("travel", [3.0, 0.25, 1e-3, 1e3])
def test_a_moving_bar_is_a_trapezoid(travel):
    """G5: travel 3 gives a plateau of 1/3, ramps of length 1 and an extent of 4."""
    row, truth, width = check_trapezoid(travel)
    if travel == 3.0:
        assert truth.max() == pytest.approx(1 / 3)
        assert np.count_nonzero(row) * width == pytest.approx(4, abs=3 * width)


@chance.fresh
def test_a_bar_at_a_million_widths_per_shutter_keeps_its_mean():
    """G5, speed 1e6: seen through a window of width 1, it is there one millionth of the time; detects 1 %."""
    travel = 1e6
    camera = OrthographicCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0), height=2e5)
    glowing = h.thing(h.quad(y=(0, 1e6, 0)), h.lambert(0, "glow", 1e5))
    scene = h.scene([h.replaced(glowing, motion=shifted((-travel / 2, 0, 0), (travel / 2, 0, 0)))], camera=camera)
    means = [h.pixels(scene, h.settings(samples=4096, seed=seed, width=32, height=32)).mean(dtype=np.float64) for seed in range(4)]
    # In the window of 2e5 it always covers 1: of a picture that it is in for a fifth of the time, a share of 5e-6.
    truth = 1e5 * 5e-6 * 0.2
    hits = 4 * 4096 * 32 * 32 * 1e-6
    assert abs(np.mean(means) / truth - 1) <= h.Z / math.sqrt(hits)


def test_a_bar_that_does_not_move_is_still_to_the_bit():
    """G5, speed 0."""
    still = h.thing(h.quad(), GLOW)
    settings = h.settings(samples=16)
    assert h.same_bits(h.pixels(h.scene([moving(still, shifted((0, 0, 0), (0, 0, 0)))]), settings), h.pixels(h.scene([still]), settings))


@pytest.mark.parametrize("slices", [4, 16])
def test_the_trapezoid_catches_slices_of_time(monkeypatch, slices):
    def sliced(plan, rays):
        return (np.floor(motion.start_time(plan, rays) * slices) + np.float32(0.5)) / slices

    monkeypatch.setattr("glanz.engine.plan.start_time", sliced)
    with pytest.raises(AssertionError):
        check_trapezoid(samples=16384)


def test_the_trapezoid_catches_a_shutter_that_is_open_2_percent_shorter(monkeypatch):
    def shorter(plan, rays):
        return np.float32(0.01) + np.float32(0.98) * motion.start_time(plan, rays)

    monkeypatch.setattr("glanz.engine.plan.start_time", shorter)
    with pytest.raises(AssertionError):
        check_trapezoid(samples=16384)


def test_times_are_stratified_within_each_pixel():
    """With n samples one falls into each n-th of the shutter: a bar is seen for its share of the time, to 1 / n at each end."""
    thing = h.replaced(h.thing(h.quad(), GLOW), motion=shifted((-1.5, 0, 0), (1.5, 0, 0)))
    scene = h.scene([thing], camera=from_above(1e-3, 8))
    assert np.abs(h.pixels(scene, h.settings(height=1, samples=64))[0] - 1 / 3).max() <= 2 / 64
    assert np.abs(h.pixels(scene, h.settings(height=1, samples=64, sampler="random", seed=3))[0] - 1 / 3).max() > 2 / 64


# G6: a spoke


def spoke(keys, samples=2048):
    """A glowing sector of 10 degrees that turns about z, seen in points at radius 0.8: (A,), and their angles (A,) [degrees]."""
    half = math.radians(5)
    corners = np.array([[0, 2, 2], [0, -2 * math.tan(half), 2 * math.tan(half)], [0, 0, 0]])
    sector = h.thing(Mesh(name="spoke", vertices=corners, triangles=[[0], [1], [2]]), GLOW)
    row = []
    for angle in np.radians(np.arange(-10, 100, 4.0)):
        x, y = 0.8 * math.cos(angle), 0.8 * math.sin(angle)
        camera = OrthographicCamera.look_at((x, y, 5), (x, y, 0), up=(0, 1, 0), height=1e-4)
        scene = h.scene([h.replaced(sector, motion=keys)], camera=camera)
        row.append(h.pixels(scene, h.settings(width=1, height=1, samples=samples, sampler="random"))[0, 0, 0])
    return np.array(row, np.float64), np.arange(-10, 100, 4.0)


def check_spoke(keys):
    row, angle = spoke(keys)
    covered = np.clip(np.minimum(angle + 5, 90) - np.maximum(angle - 5, 0), 0, None) / 90
    assert is_share(row, covered, 2048)
    assert covered.max() == pytest.approx(1 / 9)


def test_a_turning_spoke_covers_one_ninth():
    """G6: 10 degrees through 90 from two keys: constant speed along an arc, not along its chord."""
    check_spoke(turned((0, math.pi / 2)))


def test_more_keys_change_nothing_where_the_spin_is_constant():
    check_spoke(turned(np.linspace(0, math.pi / 2, 5)))


def test_the_spoke_catches_a_spin_that_is_not_constant(monkeypatch):
    """The mutant blends the two positions in a straight line, as matrices often are: up to 4 degrees off on the way."""
    at = Poses.at

    def blended(self, index, time):
        a, b = at(self, index, np.zeros_like(time)), at(self, index, np.full_like(time, 1 - 2.0**-24))
        linear = (1 - time) * a.linear + time * b.linear
        return h.replaced(a, linear=linear / np.linalg.norm(linear, axis=0))

    monkeypatch.setattr(Poses, "at", blended)
    with pytest.raises(AssertionError):
        check_spoke(turned((0, math.pi / 2)))


# Paths keep their time


@pytest.mark.parametrize("integrator", ["path", "distributed", "whitted"])
def test_the_shadow_of_what_moves_moves_with_it(integrator):
    """A card over a floor under a sun, both seen: the shadow is a trapezoid as the card's own picture, below it."""
    floor = h.thing(h.quad(x=(100, 0, 0), y=(0, 100, 0), name="floor"), h.lambert(1.0))
    card = h.thing(h.quad((0, 0, 10), (1, 0, 0), (0, 30, 0), name="card"), h.lambert(0))
    objects = [floor, moving(card, shifted((-1.5, 0, 0), (1.5, 0, 0)))]
    scene = h.scene(objects, [SunLight(irradiance=(math.pi,) * 3)], from_above(5, 50))
    settings = h.settings(width=50, height=1, samples=2048, max_depth=0, sampler="random", integrator=integrator)
    row = h.pixels(scene, settings)[0, 0].astype(np.float64)
    x = (np.arange(50) + 0.5) / 10 - 2.5
    truth = 1 - trapezoid(x, 3.0, 0.1)
    assert is_share(row, truth, 2048)


def lit_while_there(**changes):
    """The brightest pixel of a floor that moves with a card which shades it; the camera looks between them."""
    keys = shifted((-0.5, 0, 0), (1.5, 0, 0))
    card = moving(h.thing(h.quad((0, 0, 1), (1, 0, 0), (0, 9, 0), name="card"), h.lambert(0)), keys)
    floor = moving(h.thing(h.quad((0, 0, 0), (1, 0, 0), (0, 9, 0), name="floor"), h.lambert(1.0)), keys)
    camera = OrthographicCamera.look_at((0, -3.0, 0.3), (0, 0, 0), height=0.01)
    scene = h.scene([floor, card], [SunLight(irradiance=(math.pi,) * 3)], camera)
    return h.pixels(scene, h.settings(samples=64, max_depth=0, **changes)).max()


def test_shadow_rays_have_the_time_of_their_path():
    """What moves with what shades it is never lit."""
    assert lit_while_there() == 0


def test_the_shade_catches_shadow_rays_with_a_time_of_their_own(monkeypatch):
    occluded = motion.occluded_at_time

    def at_another_time(plan, carried, o, d, limit):
        return occluded(plan, Columns(time=(carried.time + np.float32(0.5)) % 1), o, d, limit)

    monkeypatch.setattr("glanz.engine.plan.occluded_at_time", at_another_time)
    assert lit_while_there() > 0.1


@chance.fresh
def test_scattered_rays_have_the_time_of_their_path():
    """A camera in a closed box that moves fast: paths stay in it, bounce by bounce, and none sees the world."""
    keys = shifted((-40, 3, 1), (40, -2, 5))
    box = h.replaced(h.thing(h.box((-1, -1, -1), (1, 1, 1)), h.lambert(1.0)), motion=keys)
    camera = PerspectiveCamera(world_from_camera=np.eye(4), motion=keys @ h.affine(h.rotation(3)), window=(-2, 2, -2, 2))
    image = h.pixels(h.scene([box], camera=camera, world=1.0), h.settings(width=32, height=32, samples=4, max_depth=20))
    assert np.count_nonzero(image) == 0


# G7: only relative motion is seen


KINDS = {
    "perspective": (PerspectiveCamera, {"window": (-0.4, 0.5, -0.3, 0.4)}),
    "orthographic": (OrthographicCamera, {"window": (-1.5, 2.5, -1.5, 1.0)}),
    "panorama": (PanoramaCamera, {}),
    "lens": (PerspectiveCamera, {"window": (-0.4, 0.5, -0.3, 0.4), "lens": Lens(radius=0.1, focus_distance=4.0)}),
    "clipped": (PerspectiveCamera, {"window": (-0.4, 0.5, -0.3, 0.4), "clip_start": 4.0, "clip_end": 5.5}),
}


def two_ways(kind):
    """Pictures of glowing things: of a camera that moves past them, of them moving past the still camera, and of all at rest."""
    plugin, attributes = KINDS[kind]
    base = scenes.everything()
    view = base.camera.world_from_camera
    objects = [h.replaced(o, materials=(h.lambert(0, f"{i}", (0.2 * i, 0.9, 0.5 - 0.1 * i)),)) for i, o in enumerate(base.objects)]
    keys = shifted((-0.3, 0.1, 0), (0.25, -0.1, 0.1)) @ turned((-0.1, 0.15), (1, 2, 0))
    camera = plugin(world_from_camera=view, motion=keys @ view, **attributes)
    settings = h.settings(width=32, height=24, samples=16)
    a = h.pixels(h.scene(objects, camera=camera, world=0.7), settings)
    # The counter-motion of a composed path is no path of keys: it is cut into many.
    fine = 65
    path = Keys.of(camera.motion)
    counter = np.stack([view @ np.linalg.inv(path.matrix(i / (fine - 1))) for i in range(fine)])
    still = plugin(world_from_camera=view, **attributes)
    b = h.pixels(h.scene([moving(o, counter) for o in objects], camera=still, world=0.7), settings)
    return a, b, h.pixels(h.scene(objects, camera=still, world=0.7), settings)


@pytest.mark.parametrize("kind", KINDS)
def test_a_moving_camera_sees_what_a_still_one_sees_of_a_counter_moving_scene(kind):
    """G7: equal seeds give equal pixels, but where rounding moves a path across an edge; without motion it is another picture."""
    a, b, still = two_ways(kind)
    assert (np.abs(a - b) <= 1e-3 * np.abs(a).max()).mean() > 0.97
    assert a.mean() == pytest.approx(b.mean(), rel=2e-3)
    assert (np.abs(a - still) > 1e-3 * np.abs(a).max()).mean() > 0.05


def together(keys):
    """The picture of glass, a liquid in it, smooth and flat things under a moving lamp, all carried along by `keys`, camera and all."""
    base = scenes.everything()
    glass = Material(name="glass", lobes=(Dielectric(ior=1.5),), medium=Medium(absorption=(0.5, 1.0, 2.0), priority=1))
    water = Material(name="water", lobes=(Dielectric(ior=1.33),), medium=Medium(absorption=(2.0, 0.3, 0.1)))
    objects = [
        *base.objects,
        h.thing(h.icosphere(2, 0.6, (1.2, -0.8, 0.7), smooth=True, name="cup"), glass),
        h.thing(h.icosphere(2, 0.5, (1.4, -0.7, 0.9), smooth=True, name="drop"), water),
    ]
    camera = base.camera
    if len(keys):
        objects = [moving(o, keys) for o in objects]
        camera = h.replaced(camera, motion=keys @ camera.world_from_camera)
    settings = h.settings(width=24, height=16, samples=16, max_depth=6, integrator="path_blind")
    return h.pixels(h.scene(objects, camera=camera, world=0.3), settings)


def test_what_moves_together_looks_as_if_it_stood_still():
    """G7 for light that bounces, breaks and is absorbed; shadow rays are left out, since lamps are chosen by where they are."""
    a, b = together(shifted((-3, 1, 2), (5, -2, 0))), together(())
    assert (np.abs(a - b) <= 2e-3 * b.max()).mean() > 0.95
    assert a.mean() == pytest.approx(b.mean(), rel=0.02)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_motion_looks_the_same_at_every_scale(scale):
    def image(s):
        base, keys = scenes.everything(scale=s), turned((-0.2, 0.3), (s, 0, 0))
        objects = [moving(o, keys) if o.name in ("smooth", "box") else o for o in base.objects]
        return h.pixels(h.replaced(base, objects=objects), h.settings(width=24, height=16, max_depth=3))

    a, b = image(1.0), image(scale)
    assert a.mean() == pytest.approx(b.mean(), rel=1e-3)
    assert (np.abs(a - b) <= 1e-3 * a).mean() > 0.95
