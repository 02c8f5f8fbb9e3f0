"""Refraction through real meshes, and light that a prism takes apart (catalogue D12, D14, D15, D16)."""

import dataclasses

import numpy as np
import pytest

from glanz.engine import Dielectric, Material, Medium, PerspectiveCamera
from glanz.engine.maths import spectrum
from glanz.engine.maths.spectrum import CHANNELS, place
from glanz.engine.wavefront import continuation, dispersion
from glanz.tests import chance, helpers as h

APEX = np.radians(60)
OPEN = Dielectric(1.5, (0.0,) * 3, (1.0,) * 3, is_fresnel=False)
"""Glass that reflects nothing: one way through."""
FLINT = dataclasses.replace(OPEN, ior=1.7, abbe=25.0)
DIAMOND = Dielectric(2.4, abbe=5.0)
"""More colours than any diamond has."""


def prism():
    """An equilateral prism along y, its edge at the top; sides of length 1."""
    corners = np.array([(-0.5, 0), (0.5, 0), (0, np.sqrt(0.75))])
    vertices = np.array([(x, y, z) for y in (-3, 3) for x, z in corners]).T
    triangles = [(0, 1, 2), (3, 5, 4), (0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (2, 5, 3), (2, 3, 0)]
    mesh = h.Mesh(name="prism", vertices=vertices, triangles=np.array(triangles).T)
    assert (np.cross(*(vertices[:, mesh.triangles[k]].T - vertices[:, mesh.triangles[0]].T for k in (1, 2)))[2:4, 2] < 0).all()
    return mesh


def deviation(incidence, index):
    """By how much a prism turns light that meets it at the angle `incidence`."""
    inner = np.sqrt(index**2 - np.sin(incidence) ** 2)
    return incidence + np.arcsin(inner * np.sin(APEX) - np.sin(incidence) * np.cos(APEX)) - APEX


def turned_by_prism(lobe, incidence, scale=1.0, offset=(0.0, 0.0, 0.0), integrator="path", samples=1, **settings):
    """Turns [rad] of all rays that have left the prism, and what they carried: arrays (N,), and throughputs (3, N)."""
    # The left side faces (-sin 60, 0, cos 60); light comes from below its normal.
    normal = np.array((-np.sin(APEX), 0, np.cos(APEX)))
    along = np.array((-np.cos(APEX), 0, -np.sin(APEX)))
    towards_eye = np.cos(incidence) * normal + np.sin(incidence) * along
    target = np.array((-0.25, 0.3, np.sqrt(0.75) / 2))
    camera = PerspectiveCamera.look_at(scale * (target + towards_eye) + offset, scale * target + offset, up=(0, 1, 0), fov=1e-6)
    thing = h.thing(prism(), Material(name="glass", lobes=(lobe,)), h.affine(scale * np.eye(3), offset))
    scene = h.scene([thing], camera=camera, world=1.0)
    plan = h.plan_of(scene, h.settings(width=1, height=1, samples=samples, max_depth=9, integrator=integrator, **settings))
    left = []

    def catch(plan, rays, surface, reflection, scattered):
        if rays.depth == 1:
            left.append(scattered)

    h.pixels_of_plan(dataclasses.replace(plan, on_leaving=(*plan.on_leaving, catch)))
    d = np.concatenate([rays.d.astype(np.float64) for rays in left], axis=1)
    beta = np.concatenate([rays.beta for rays in left], axis=1)
    wavelength = np.concatenate([getattr(rays.carried, "wavelength", np.zeros(rays.slot.size)) for rays in left])
    return np.arctan2(np.linalg.norm(np.cross(d.T, -towards_eye), axis=1), -towards_eye @ d), wavelength, beta


@pytest.fixture(autouse=True)
def no_roulette(monkeypatch):
    """Weak paths are followed to their end."""
    monkeypatch.setattr(continuation, "ROULETTE_DEPTH", 10**6)


@pytest.mark.parametrize(("scale", "offset"), [(1, (0, 0, 0)), (1e-6, (0, 0, 0)), (1e6, (0, 0, 0)), (1, (1e5, -1e5, 1e5))], ids=str)
def test_a_prism_turns_light_by_its_least_deviation(scale, offset):
    """D14: 2 asin(n sin 30) - 60 = 37.180756 degrees, where the way inside is level; to 5e-7 rad, eight units of float32."""
    turn, _, _ = turned_by_prism(OPEN, np.arcsin(1.5 / 2), scale, offset)
    assert turn == pytest.approx(np.radians(37.180756), abs=5e-7)


def test_the_turn_catches_a_wrong_index():
    turn, _, _ = turned_by_prism(dataclasses.replace(OPEN, ior=1.5001), np.arcsin(1.5 / 2))
    assert turn != pytest.approx(np.radians(37.180756), abs=5e-7)


@pytest.mark.parametrize("scale", [1e-6, 1, 1e6])
def test_a_slab_shifts_light_to_the_side(scale):
    """D12: t sin(i - r) / cos r at 45 degrees, n = 1.5, t = 1: .329142308, read off a ramp of light beyond; to 1e-5."""
    pane = h.thing(h.box((-3, -3, 0), (3, 3, 1)), Material(name="pane", lobes=(OPEN,)), h.affine(scale * np.eye(3)))
    camera = PerspectiveCamera.look_at((scale, 0.1 * scale, 2 * scale), (0, 0.1 * scale, scale), up=(0, 1, 0), fov=1e-6)
    plan = h.plan_of(h.scene([pane], camera=camera, world=1.0), h.settings(width=1, height=1, samples=1))
    left = []
    catch = lambda plan, rays, surface, reflection, scattered: left.append((surface.p, scattered.d))  # noqa: E731
    h.pixels_of_plan(dataclasses.replace(plan, on_leaving=(catch,)))
    # Render space is centred on the camera: how far the line beyond passes it is the shift.
    p, d = (a[:, 0].astype(np.float64) for a in left[1])
    assert np.linalg.norm(np.cross(p, d)) / plan.world.frame.scale / scale == pytest.approx(0.329142308, abs=1e-5)


def test_the_shift_catches_a_wrong_index(monkeypatch):
    monkeypatch.setitem(globals(), "OPEN", dataclasses.replace(OPEN, ior=1.5002))
    with pytest.raises(AssertionError):
        test_a_slab_shifts_light_to_the_side(1)


def test_the_turns_catch_a_spectrum_the_wrong_way_round(monkeypatch):
    """Anomalous: red bent most."""
    monkeypatch.setattr(dispersion, "place", lambda wavelength: -place(wavelength))
    with pytest.raises(AssertionError):
        test_every_wavelength_has_its_own_turn()


def test_every_wavelength_has_its_own_turn():
    """D15, through the mesh: one wavelength for each path, and the prism's formula for its index; to 2e-6 rad."""
    incidence = 1.0
    turn, wavelength, beta = turned_by_prism(FLINT, incidence, samples=256)
    assert turn.size == 256
    assert wavelength.min() < 430 and wavelength.max() > 650
    expected = deviation(incidence, FLINT.ior + FLINT.spread * place(wavelength.astype(np.float64)))
    assert np.abs(turn - expected).max() <= 2e-6
    assert np.ptp(turn) > np.radians(3)
    # Red is turned least, blue most, and together they are white: stratified samples share out the spectrum.
    assert beta[0][turn.argmin()] > 2 and beta[2][turn.argmax()] > 2
    assert beta.mean(axis=1) == pytest.approx(1, abs=0.02)


@pytest.mark.parametrize("integrator", ["whitted", "whitted_phong"])
def test_whitted_sends_a_ray_for_each_channel(integrator):
    """Three rays leave, each of one colour and turned by that channel's index; where nothing is spread it is one."""
    incidence = 1.0
    turn, _, beta = turned_by_prism(FLINT, incidence, integrator=integrator)
    lit = np.nonzero(beta.any(axis=0))[0]
    assert lit.size == 3
    assert beta[:, lit] == pytest.approx(np.eye(3), rel=1e-5)
    assert turn[lit] == pytest.approx(deviation(incidence, FLINT.ior + FLINT.spread * place(CHANNELS[:, 0].astype(np.float64))), abs=2e-6)
    turn, _, beta = turned_by_prism(OPEN, incidence, integrator=integrator)
    assert np.count_nonzero(beta.any(axis=0)) == 1


CAMERA = PerspectiveCamera.look_at((0.1, -4, 0.3), (0, 0, 0), fov=0.6)


def ball(lobe, radius=1.0, name="ball", **material):
    return h.thing(h.icosphere(3, radius, smooth=True, name=name), Material(name=name, lobes=(lobe,), **material))


def seen_in_even_light(things, **settings):
    scene = h.scene(things, camera=CAMERA, world=1.0)
    return h.pixels(scene, h.settings(width=48, height=48, samples=64, max_depth=200, **settings))


@pytest.mark.parametrize("nested", [False, True])
@pytest.mark.parametrize("sampler", ["random", "stratified"])
@chance.fresh
def test_white_stays_white(nested, sampler):
    """D16: glass that spreads colours, alone and around a bubble, is as bright as even light around it, in each channel; detects 1 %."""
    things = [ball(DIAMOND), *([ball(Dielectric(1.0), 0.6, "bubble")] if nested else [])]
    image = seen_in_even_light(things, sampler=sampler)
    for channel in image:
        assert h.mean_is(channel.ravel(), 1.0, floor=1e-6)


def test_even_light_catches_weights_that_are_not_those_of_the_sampling(monkeypatch):
    sample = dispersion.sample_wavelength

    def evenly(u1):
        return 400 + 300 * u1, sample(u1)[1] * np.float32([[1.1], [1], [1]])

    monkeypatch.setattr(dispersion, "sample_wavelength", evenly)
    with pytest.raises(AssertionError):
        test_white_stays_white(False, "random")


@chance.fresh
def test_a_dispersive_slab_at_right_angles_passes_white():
    """D16: T = 2 n / (n^2 + 1) of each wavelength; the mean of each channel over its wavelengths; detects 0.7 %."""
    slab = h.thing(h.box((-3, -3, 0), (3, 3, 1)), Material(name="slab", lobes=(DIAMOND,)))
    glow = h.thing(h.quad((0, 0, -3), (90, 0, 0), (0, 90, 0)), Material(name="glow", emission=(1.0, 1.0, 1.0)))
    camera = PerspectiveCamera.look_at((0.1, 0.2, 5), (0.1, 0.2, 0), up=(0, 1, 0), fov=1e-4)
    image = h.pixels(h.scene([slab, glow], camera=camera), h.settings(width=16, height=16, samples=1024, max_depth=60))
    n = DIAMOND.ior + DIAMOND.spread * place(spectrum._MIDDLES)
    for channel, shares in zip(image, spectrum._SHARES):
        assert h.mean_is(channel.ravel(), (shares * 2 * n / (n * n + 1)).sum(), floor=2e-4)


def test_paths_that_meet_no_dispersion_keep_every_bit():
    """A dull ball beside one that spreads colours: its pixels are those of the scene in which nothing does."""
    dull = h.thing(h.icosphere(2, 0.5, (-2, 0, 0), name="dull"), h.lambert(0.5))
    camera = PerspectiveCamera.look_at((-1, -6, 0), (-1, 0, 0), fov=0.8)
    plain, spread = (
        h.pixels(
            h.scene([dull, ball(dataclasses.replace(DIAMOND, abbe=abbe))], camera=camera, world=1.0),
            h.settings(width=16, height=16, samples=8, max_depth=1),
        )
        for abbe in (float("inf"), 5.0)
    )
    assert not h.same_bits(plain, spread)
    assert h.same_bits(plain[:, :, :7], spread[:, :, :7])


def test_a_clear_bubble_in_dispersive_glass_takes_light_apart():
    """What is around counts too: a camera inside of the glass sees colours at the edge of a bubble that has none of its own."""
    bubble = ball(Dielectric(1.0), 0.5, "bubble", medium=Medium(priority=1))
    glass = ball(DIAMOND, 9.0, "glass")
    camera = PerspectiveCamera.look_at((0.1, -3, 0.2), (0, 0, 0), fov=0.4)
    plan = h.plan_of(h.scene([bubble, glass], camera=camera, world=1.0), h.settings(samples=4))
    white = []

    def catch(plan, rays, surface, reflection, scattered):
        if rays.depth == 0:
            white.append(scattered.carried.wavelength == 0)

    h.pixels_of_plan(dataclasses.replace(plan, on_leaving=(*plan.on_leaving, catch)))
    assert not np.concatenate(white).any()
