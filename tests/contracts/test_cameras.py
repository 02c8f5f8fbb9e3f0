"""What every camera promises (`interfaces.Camera`), checked for every class in the registry."""

import math

import numpy as np
import pytest

from glanz.engine import Lens, PanoramaCamera, SceneError, render_image
from glanz.engine.arrays import columns
from glanz.engine.interfaces import Camera
from glanz.engine.registry import CAMERAS
from glanz.engine.wavefront.visibility import all_the_way
from glanz.tests import helpers as h, scenes

each = pytest.mark.parametrize("plugin", CAMERAS.values(), ids=lambda p: p.key)
WIDTH, HEIGHT = 320, 180
OPEN = Lens(radius=0.25, focus_distance=3.0, blades=5, rotation=0.3, ratio=1.5)
N = 20_000


def at_the_scene(plugin, **changes):
    """A camera that sees `scenes.everything` from where its own camera does."""
    return plugin(name="Eye", world_from_camera=scenes.everything().camera.world_from_camera, **changes)


def film(dtype=np.float64):
    """Positions all over the frame, (2, N)."""
    return ((h.uniform(1, N) - 0.5) * [[WIDTH], [HEIGHT]]).astype(dtype)


def parameters(camera, scale=1.0, dtype=np.float64):
    return columns([camera.row(WIDTH, HEIGHT, scale)], dtype)


@each
def test_a_camera_offers_the_interface(plugin):
    camera = plugin()
    assert isinstance(camera, Camera)
    assert CAMERAS[plugin.key] is plugin
    assert plugin.__doc__.strip()
    assert (camera.clip_start, camera.clip_end) == (0, math.inf)
    assert not camera.lens.is_open
    camera.check()
    assert camera.position.shape == (3,)
    assert camera.position.dtype == np.float64


@each
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_rays_keep_their_kind_of_number_and_are_unit(plugin, dtype):
    k = parameters(at_the_scene(plugin, lens=OPEN), dtype=dtype)
    lens = (h.uniform(2, N) - 0.5).astype(dtype)
    for o, d in (plugin.rays(k, *film(dtype)), plugin.lens_rays(k, *film(dtype), lens)):
        assert o.shape == d.shape == (3, N)
        assert o.dtype == d.dtype == dtype
        assert np.abs(h.dots(d, d) - 1).max() <= 4 * np.finfo(dtype).eps
        assert plugin.depth(k, d).dtype == plugin.ray_per_depth(k, d).dtype == dtype


@each
def test_a_point_at_a_depth_is_that_far_along_the_ray(plugin):
    """depth(o + t d) = z for t = z ray_per_depth(d), through a lens as well, but for a panorama's lens."""
    k = parameters(at_the_scene(plugin, lens=OPEN))
    lens = h.uniform(2, N) - 0.5 if plugin is not PanoramaCamera else np.zeros((2, N))
    for o, d in (plugin.rays(k, *film()), plugin.lens_rays(k, *film(), lens)):
        z = h.uniform(3, N)[0] * 10
        np.testing.assert_allclose(plugin.depth(k, o + z * plugin.ray_per_depth(k, d) * d), z, atol=1e-12)


def check_focus(plugin, lens_rays):
    """G3: to 1e-12, whatever the scale of render space."""
    for scale in (1.0, 2.0**-5):
        k = parameters(at_the_scene(plugin, lens=OPEN), scale)
        o, d = plugin.rays(k, *film())
        sharp = o + OPEN.focus_distance * scale * plugin.ray_per_depth(k, d) * d
        lens = scale * 0.25 * (h.uniform(2, N) - 0.5)
        p, w = lens_rays(k, *film(), lens)
        assert np.abs(p - o).max() > 0.01 * scale
        away = sharp - p
        distance = away - h.dots(away, w) * w
        assert np.abs(distance).max() <= 1e-12
        # The point of the lens lies across the ray or the axis, at its distance from the middle.
        np.testing.assert_allclose(np.linalg.norm(p - o, axis=0), np.hypot(*lens), rtol=1e-9)


@each
def test_all_rays_of_a_film_position_meet_in_focus(plugin):
    check_focus(plugin, plugin.lens_rays)


@each
def test_focus_catches_a_lens_that_is_off_by_a_thousandth(plugin):
    def other(k, x, y, lens):
        k.per_focus = k.per_focus * 1.001
        return plugin.lens_rays(k, x, y, lens)

    with pytest.raises(AssertionError):
        check_focus(plugin, other)


@each
def test_the_middle_of_the_lens_is_the_pinhole_to_the_bit(plugin):
    """G3: in float32, so that an aperture of 0 gives the same picture."""
    k = parameters(at_the_scene(plugin, lens=OPEN), dtype=np.float32)
    ours, theirs = plugin.lens_rays(k, *film(np.float32), np.zeros((2, N), np.float32)), plugin.rays(k, *film(np.float32))
    for a, b in zip(ours, theirs):
        assert (a == b).all()


def picture(camera, **changes):
    return h.pixels(h.replaced(scenes.everything(), camera=camera), h.settings(width=24, height=16, samples=4, **changes))


@each
def test_a_lens_without_an_opening_changes_no_bit_and_one_with_does(plugin):
    sharp = picture(at_the_scene(plugin))
    assert h.same_bits(picture(at_the_scene(plugin, lens=Lens(focus_distance=2.0, blades=6))), sharp)
    assert not h.same_bits(picture(at_the_scene(plugin, lens=OPEN)), sharp)


def shell(radius, emission=1.0):
    """A glowing sphere around the camera."""
    return h.thing(h.icosphere(4, radius, scenes.everything().camera.position, name="shell"), h.lambert(0, "glow", emission))


@each
def test_a_card_out_of_focus_keeps_its_radiance(plugin):
    """G4: what fills the view looks the same through any lens; every sample weighs 1, to the last bit."""
    scene = h.scene([shell(40.0, 0.75)], camera=at_the_scene(plugin, lens=OPEN))
    assert (h.pixels(scene, h.settings()) == 0.75).all()


@each
def test_a_wide_clip_range_changes_rays_by_rounding_only(plugin):
    sharp = picture(at_the_scene(plugin)).mean()
    assert picture(at_the_scene(plugin, clip_start=0.01, clip_end=1e4)).mean() == pytest.approx(sharp, rel=2e-3)


def disk_at(distance, camera, size=1e3):
    """A large glowing square across the axis of `camera`."""
    u, v, w = camera.world_from_camera[:3, :3].T
    return h.thing(h.quad(camera.world_from_camera[:3, 3] - distance * w, size * u, size * v), h.lambert(0, "glow", 1.0))


def things_at(distance, camera):
    return [shell(distance) if isinstance(camera, PanoramaCamera) else disk_at(distance, camera)]


def check_clip(plugin, seen=lambda scene: h.pixels(scene, h.settings())):
    """What is inside of the range by a thousandth is seen in all pixels, and what is outside in none."""
    camera = at_the_scene(plugin, clip_start=2.0, clip_end=7.0)
    # The shell is made of flat triangles: between 0.998 and 1 of its radius.
    for distance, is_seen in ((1.998, False), (2.01, True), (6.99, True), (7.03, False)):
        assert (seen(h.scene(things_at(distance, camera), camera=camera)) == is_seen).all(), distance


@each
def test_camera_rays_meet_only_what_is_in_the_clip_range(plugin):
    """Along the axis, for a panorama along the ray: up to the corners of a wide view."""
    check_clip(plugin)


@each
def test_the_clip_range_catches_an_end_that_is_not_moved_with_the_start(plugin, monkeypatch):
    row = "glanz.engine.plan.clip_row"
    monkeypatch.setattr(row, lambda camera, scale: {"clip_start": camera.clip_start * scale, "clip_length": camera.clip_end * scale})
    with pytest.raises(AssertionError):
        check_clip(plugin)


@each
def test_the_clip_range_is_that_of_camera_rays_alone(plugin, monkeypatch):
    """A floor lit by a sun under a card that is clipped away: the card is not seen, and its shadow is."""
    camera = at_the_scene(plugin, clip_start=2.0)
    u, v, w = camera.world_from_camera[:3, :3].T
    floor = h.thing(h.quad(camera.world_from_camera[:3, 3] - 4 * w, 100 * u, 100 * v, name="floor"), h.lambert(1.0))
    card = h.thing(h.quad(camera.world_from_camera[:3, 3] - 1.5 * w, 100 * u, 100 * v, name="card"), h.lambert(0, "glow", 0.0))
    sun = scenes.everything().lights[2]
    sun = h.replaced(sun, towards=tuple(w), irradiance=(math.pi,) * 3, angle=0.0)
    settings = h.settings(max_depth=0)
    lit, dark = (h.pixels(h.scene(objects, [sun], camera), settings) for objects in ([floor], [floor, card]))
    assert lit[:, 4, 4] == pytest.approx(1, rel=1e-5)
    assert (dark[:, 4, 4] == 0).all()
    # The card is what makes it dark: beside the floor alone it would be black as well without a clip range.
    depth = render_image(h.scene([floor, card], camera=camera), h.settings(passes=("Depth",))).passes["Depth"]
    assert depth[4, 4, 0] == pytest.approx(4, rel=0.3)
    near = h.replaced(camera, clip_start=0.0)
    depth = render_image(h.scene([floor, card], camera=near), h.settings(passes=("Depth",))).passes["Depth"]
    assert depth[4, 4, 0] == pytest.approx(1.5, rel=0.3)


@each
def test_lights_beyond_the_clip_range_are_not_seen(plugin):
    camera = at_the_scene(plugin)
    middle = camera.position - 5 * camera.world_from_camera[:3, 2]
    lamp = h.replaced(scenes.everything().lights[0], position=tuple(middle.tolist()), radius=1.0, is_visible=True)
    for changes, is_seen in (({}, True), ({"clip_start": 3.0}, True), ({"clip_start": 6.5}, False), ({"clip_end": 3.0}, False)):
        image = h.pixels(h.scene([], [lamp], h.replaced(camera, **changes)), h.settings(width=33, height=33, samples=16))
        assert (image.max() > 0) == is_seen, changes


BAD = {
    "clip range is -inf": {"clip_start": -math.inf},
    "clip range is nan": {"clip_start": math.nan},
    "clip range is 0.0 to nan": {"clip_end": math.nan},
    "clip range is 5.0 to 5.0": {"clip_start": 5.0, "clip_end": 5.0},
    "clip range is inf": {"clip_start": math.inf},
    "aperture radius is -1": {"lens": Lens(radius=-1.0)},
    "aperture radius is inf": {"lens": Lens(radius=math.inf)},
    "focus distance is 0": {"lens": Lens(radius=1.0, focus_distance=0.0)},
    "focus distance is nan": {"lens": Lens(radius=1.0, focus_distance=math.nan)},
    "number of aperture blades is 2": {"lens": Lens(blades=2)},
    "number of aperture blades is 3.5": {"lens": Lens(blades=3.5)},
    "number of aperture blades is -3": {"lens": Lens(blades=-3)},
    "aperture rotation is inf": {"lens": Lens(rotation=math.inf)},
    "aperture ratio is 0": {"lens": Lens(ratio=0.0)},
}


@each
@pytest.mark.parametrize("message", BAD)
def test_what_cannot_be_is_refused_by_name(plugin, message):
    with pytest.raises(SceneError, match=f"camera 'Eye': {message}"):
        picture(at_the_scene(plugin, **BAD[message]))


def test_without_a_clip_range_rays_are_met_as_before():
    plan = h.plan_of(scenes.everything(), h.settings())
    assert plan.reach is all_the_way
    assert plan.on_camera_rays == ()
