"""Light that is reflected many times against geometric series (catalogue F1-F3, F7, F11, F12).

`max_depth` d bounces: a picture holds what surfaces emit, the light that they receive directly, and that light
reflected up to d times more. In a closed mesh that emits E and reflects r everywhere: E (1 + r + ... + r^(d + 1)).
"""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, Lambert, Material, PerspectiveCamera, Phong, PointLight, SpotLight
from glanz.engine.maths.hashing import mix
from glanz.engine.wavefront import continuation, emission
from glanz.engine.wavefront.film import Film
from glanz.engine.wavefront.loop import trace
from glanz.engine.wavefront.records import Rays
from glanz.tests import chance, helpers as h

INSIDE = PerspectiveCamera.look_at((0.3, 0.4, 0.5), (0.9, 0.8, 0.2), fov=math.radians(80))
MESHES = {"box": h.box(), "sphere": h.icosphere(1, centre=(0.4, 0.5, 0.5)), "prism": h.box((0, 0, 0), (1, 1, 40.0))}


def series(emission, r, depth):
    """E (1 - r^(d + 2)) / (1 - r)."""
    return emission * sum(r**k for k in range(depth + 2))


def furnace(mesh, r, emission=1.0):
    return h.scene([h.thing(mesh, h.lambert(r, "wall", emission))], camera=INSIDE)


def without_shadow_rays(monkeypatch, scene, settings):
    """A `Plan` that scatters only, weighs nothing and never ends a path: no noise is left in a furnace."""
    monkeypatch.setattr(emission, "power_heuristic", lambda pdf, other: np.float32(1))
    monkeypatch.setattr(continuation, "ROULETTE_DEPTH", 10**9)
    return h.replaced(h.plan_of(scene, settings), on_surface=())


@pytest.mark.parametrize("depth", [0, 1, 2, 10])
@pytest.mark.parametrize("r", [0.0, 0.5, 0.8, 0.999])
def test_every_path_in_a_furnace_sums_the_series(monkeypatch, r, depth):
    """F1 without shadow rays and roulette: each pixel to 2e-6, float32."""
    plan = without_shadow_rays(monkeypatch, furnace(h.box(), r), h.settings(max_depth=depth))
    np.testing.assert_allclose(h.pixels_of_plan(plan), series(1.0, r, depth), rtol=2e-6)


@pytest.mark.parametrize("name", MESHES)
def test_every_closed_mesh_is_a_furnace(monkeypatch, name):
    plan = without_shadow_rays(monkeypatch, furnace(MESHES[name], 0.8, (3.0, 2.0, 1.0)), h.settings(max_depth=3))
    truth = np.array((3.0, 2.0, 1.0))[:, None, None] * series(1.0, 0.8, 3)
    np.testing.assert_allclose(h.pixels_of_plan(plan), np.broadcast_to(truth, (3, 8, 8)), rtol=2e-6)


@pytest.mark.parametrize("scale", [2.0**-40, 1e-6, 1e6, 2.0**40])
@pytest.mark.parametrize(
    "linear", [np.eye(3), np.diag((-1.0, 2.0, 0.5)), h.rotation(2) @ np.diag((1.0, 1.0, -30.0))], ids=["as is", "mirrored", "long"]
)
def test_the_furnace_does_not_depend_on_scale_or_handedness(monkeypatch, scale, linear):
    """F1 and A14 through the transform of the object: mirrored, stretched, at each scale; each pixel to 2e-6."""
    matrix = h.affine(scale * linear, (3 * scale, -scale, 2 * scale))
    eye, target = (matrix[:3, :3] @ np.array(p) + matrix[:3, 3] for p in ((0.3, 0.4, 0.5), (0.9, 0.8, 0.2)))
    camera = PerspectiveCamera.look_at(eye, target, fov=math.radians(80))
    scene = h.scene([h.thing(h.box(), h.lambert(0.8, "wall", 1.0), matrix)], camera=camera)
    plan = without_shadow_rays(monkeypatch, scene, h.settings(max_depth=2))
    np.testing.assert_allclose(h.pixels_of_plan(plan), series(1.0, 0.8, 2), rtol=2e-6)


@pytest.mark.parametrize("depth", [0, 2, 40])
@pytest.mark.parametrize("name", ["box", "sphere"])
@chance.fresh
def test_the_furnace_is_the_same_with_shadow_rays_and_roulette(name, depth):
    """F1 as it is rendered; detects 1 %."""
    image = h.pixels(furnace(MESHES[name], 0.8), h.settings(width=16, height=16, samples=64, max_depth=depth))
    assert h.mean_is(image[0], series(1.0, 0.8, depth), floor=1e-5)


def test_the_series_catches_a_bounce_too_many_or_too_few():
    image = h.pixels(furnace(h.box(), 0.8), h.settings(width=16, height=16, samples=64, max_depth=2))
    assert not h.mean_is(image[0], series(1.0, 0.8, 1))
    assert not h.mean_is(image[0], series(1.0, 0.8, 3))


def test_the_series_catches_roulette_that_forgets_its_probability(monkeypatch):
    survive = continuation.survive

    def forgetful(*args):
        alive, q = survive(*args)
        return alive, np.ones_like(q)

    monkeypatch.setattr(continuation, "survive", forgetful)
    image = h.pixels(furnace(h.box(), 0.8), h.settings(width=16, height=16, samples=64, max_depth=10))
    assert not h.mean_is(image[0], series(1.0, 0.8, 10))


@pytest.mark.parametrize("r", [0.1, 0.5, 0.9])
@chance.fresh
def test_roulette_does_not_change_the_mean(monkeypatch, r):
    """F7: with it, without it, and with an early start; detects 1 %."""
    scene, settings = furnace(h.box(), r), h.settings(width=16, height=16, samples=32, max_depth=12)
    images = [h.pixels(scene, settings)]
    for start in (0, 10**9):
        monkeypatch.setattr(continuation, "ROULETTE_DEPTH", start)
        images.append(h.pixels(scene, h.replaced(settings, seed=start + 1)))
    for a, b in ((0, 1), (0, 2), (1, 2)):
        assert h.means_agree(images[a][0], images[b][0], floor=1e-6)


@pytest.mark.parametrize("light", [0, 1, 2, 3])
@chance.fresh
def test_photons_are_lost_only_where_they_are_absorbed(light):
    """F3: in a cube of side 2 that reflects r = 0.5, any lights of flux Phi give the mean irradiance Phi / (A (1 - r)).

    I = 1 W / sr anywhere: 1.047198 W / m^2, mean radiance 0.166667. The mean is over the surface: camera rays are
    replaced by rays at points uniform on the walls, straight from above. Detects 1.5 %.
    """
    lights, flux = {
        0: ([PointLight(position=(0.3, -0.2, 0.4))], 4 * math.pi),
        1: ([PointLight(position=(-0.4, 0.2, 0.3), radius=0.3, soft_falloff=False)], 4 * math.pi),
        2: ([AreaLight(world_from_light=h.affine(h.rotation(3), (0.1, 0.2, 0.3)), size_x=0.5, size_y=0.3)], math.pi * 0.15),
        3: (
            [
                PointLight(position=(0.5, -0.2, 0.4)),
                SpotLight(intensity=(2.0,) * 3, angle=1.0, blend=0.0),
                PointLight(position=(0, -0.6, 0)),
            ],
            4 * math.pi * (2 + 2 * 0.5 * (1 - math.cos(0.5))),
        ),
    }[light]
    camera = PerspectiveCamera.look_at((0.1, 0.1, 0.1), (1, 1, 1))
    plan = h.plan_of(h.scene([h.thing(h.box((-1, -1, -1), (1, 1, 1)))], lights, camera), h.settings(max_depth=30, sampler="random"))
    n = 100_000
    radiance = radiance_of_rays(plan, *above_the_walls(n))
    assert h.mean_is(radiance[0].reshape(100, -1).mean(axis=1), flux / 24 / (1 - 0.5) * 0.5 / math.pi, floor=1e-5)
    if light == 0:
        assert flux / 24 / 0.5 * 0.5 / math.pi == pytest.approx(1 / 6)


def above_the_walls(n):
    """Origins half way to the middle of a cube of side 2, and directions to uniform points on its walls, (3, n)."""
    rng = np.random.default_rng(6)
    axis, side = rng.integers(0, 3, n), rng.choice((-1.0, 1.0), n)
    points = rng.uniform(-1, 1, (3, n))
    points[axis, np.arange(n)] = 0.5 * side
    d = np.zeros((3, n))
    d[axis, np.arange(n)] = side
    return points, d


def radiance_of_rays(plan, points, d):
    """What each ray sees, (3, N): the engine's loop, with rays of our own."""
    n = points.shape[1]
    film = Film(n, plan.passes)
    film.open(1, slice(0, n))
    rays = Rays(
        o=plan.world.frame.points(points).astype(np.float32),
        d=d.astype(np.float32),
        beta=np.ones((3, n), np.float32),
        pdf=np.zeros(0, np.float32),
        slot=np.arange(n),
        key=mix(np.arange(n, dtype=np.uint32)),
        sample=np.zeros(n, np.uint32),
        depth=0,
    )
    assert trace(plan, [rays], film)
    return film.radiance.astype(np.float64)


def test_balance_catches_light_that_leaks(monkeypatch):
    """The mutant loses 3 % of the light at each reflection."""
    monkeypatch.setattr(Lambert, "eval", staticmethod(lambda k, n, wo, wi: k.reflectance * np.float32(0.97 / math.pi)))
    camera = PerspectiveCamera.look_at((0.1, 0.1, 0.1), (1, 1, 1))
    lights = [PointLight(position=(0.3, -0.2, 0.4))]
    plan = h.plan_of(h.scene([h.thing(h.box((-1, -1, -1), (1, 1, 1)))], lights, camera), h.settings(max_depth=30, sampler="random"))
    radiance = radiance_of_rays(plan, *above_the_walls(100_000))
    assert not h.mean_is(radiance[0].reshape(100, -1).mean(axis=1), 1 / 6, floor=1e-5)


WHITE_OBJECTS = {
    "sphere": h.thing(h.icosphere(2), h.lambert(1.0)),
    "box": h.thing(h.box((-1, -1, -1)), h.lambert(1.0)),
    "smooth sphere": h.thing(h.icosphere(4, smooth=True), h.lambert(1.0)),
}


@pytest.mark.parametrize("name", WHITE_OBJECTS)
def test_a_white_convex_object_vanishes_in_white_light(name):
    """F2: albedo 1 in a world of radiance 1. Flat: each pixel to 2e-6; smooth: to the light that falls below facets."""
    image = h.pixels(h.scene([WHITE_OBJECTS[name]], world=1.0), h.settings(width=16, height=16, max_depth=4))
    np.testing.assert_allclose(image, 1, rtol=2e-6 if name != "smooth sphere" else 0.15)
    assert image.mean() == pytest.approx(1, abs=1e-6 if name != "smooth sphere" else 5e-3)


@chance.fresh
def test_white_concave_objects_vanish_in_white_light():
    """F2 with many bounces; detects 0.5 %. Paths of more than 100 bounces carry less than 1e-3 of the light here."""
    well = [h.quad(c, x, y, name=f"{c}") for c, x, y in (
        ((0, 0, -1), (2, 0, 0), (0, 2, 0)), ((1, 0, 0), (0, 2, 0), (0, 0, 2)), ((-1, 0, 0), (0, 2, 0), (0, 0, 2)),
        ((0, 1, 0), (2, 0, 0), (0, 0, 2)), ((0, -1, 0), (2, 0, 0), (0, 0, 2)),
    )]  # fmt: skip
    camera = PerspectiveCamera.look_at((0.3, 0.4, 4), (0, 0, 0), up=(0, 1, 0))
    scene = h.scene([h.thing(q, h.lambert(1.0)) for q in well], camera=camera, world=1.0)
    image = h.pixels(scene, h.settings(width=16, height=16, samples=16, max_depth=100))
    assert h.mean_is(image[0], 1.0, floor=1e-3)
    assert not h.mean_is(1.005 * image[0], 1.0, floor=1e-3)


@pytest.mark.parametrize(
    ("n", "degrees", "albedo"),
    [
        (10.0, 0, 1.0),
        (10.0, 45, 0.707374),
        (10.0, 80, 0.228056),
        *((n, 0, 1.0) for n in (0.0, 0.5, 1e3, 1e6)),
        (0.0, 60, 0.75),
        (1e6, 60, 0.5),
    ],
)
@chance.fresh
def test_a_phong_surface_in_white_light_shows_its_albedo(n, degrees, albedo):
    """F2 and C2 to C5: for n = 10, at both ends, and for a sharp lobe the cosine; detects 0.5 %."""
    material = Material(name="shiny", lobes=(Phong((1.0, 1.0, 1.0), n),))
    scene = h.replaced(h.receiver(material=material, tilt=math.radians(degrees)), world=h.World(radiance=(1.0,) * 3))
    image = h.pixels(scene, h.settings(width=16, height=16, samples=256, max_depth=0))
    assert h.mean_is(image[0], albedo, floor=1e-4 if n == 1e6 else 1e-5)
    assert not h.mean_is(1.005 * image[0], albedo, floor=1e-5)


def test_more_depth_is_more_light_and_converges():
    """F11: monotone in depth; each bounce adds what the series says; 1000 bounces end."""
    means = [
        h.pixels(furnace(h.box(), 0.8), h.settings(width=32, height=32, samples=16, max_depth=d))[0].mean() for d in (0, 1, 2, 5, 1000)
    ]
    assert (np.diff(means) > 0).all()
    np.testing.assert_allclose(means, [series(1, 0.8, d) if d < 1000 else 5.0 for d in (0, 1, 2, 5, 1000)], rtol=0.02)


def coloured(channel=None):
    """A scene of coloured walls and lights, or one channel of it as greys."""

    def only(c):
        return c if channel is None else (c[channel],) * 3

    walls = Material(name="wall", lobes=(Lambert(only((0.8, 0.5, 0.2))),))
    light = PointLight(position=(0.4, 0.6, 0.7), intensity=only((1.0, 2.0, 3.0)))
    return h.scene([h.thing(h.box(), walls)], [light], INSIDE)


def test_channels_do_not_mix():
    """F12: a picture is its three greys, bit for bit, as long as roulette, which looks at the brightest, does not play."""
    settings = h.settings(max_depth=1)
    image = h.pixels(coloured(), settings)
    for channel in range(3):
        assert h.same_bits(h.pixels(coloured(channel), settings)[0], image[channel])
    assert (image[0] != image[1]).any()


@chance.fresh
def test_channels_do_not_mix_on_average_where_roulette_plays():
    """F12 with many bounces; detects 2 %."""
    settings = h.settings(width=16, height=16, samples=64, max_depth=8)
    image = h.pixels(coloured(), settings)
    for channel in range(3):
        grey = h.pixels(coloured(channel), h.replaced(settings, seed=channel + 1))[0]
        # Pixel by pixel, or what they differ by among each other would hide what channels differ by.
        assert h.mean_is(grey - image[channel], 0)
        assert not h.mean_is(1.02 * grey - image[channel], 0)
