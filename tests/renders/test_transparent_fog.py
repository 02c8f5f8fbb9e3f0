"""Surfaces that light passes straight on, around media and in motion: what rays carry is renewed as they pass."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, Dielectric, Material, Medium, PerspectiveCamera, PointLight, Transparent
from glanz.engine.wavefront import media
from glanz.tests import helpers as h

SIGMA = np.array((0.1, 0.7, 2.0))
TINT = np.array((0.9, 0.5, 0.25))
DOWN = PerspectiveCamera.look_at((0.1, 0.2, 9), (0.1, 0.2, 0), up=(0, 1, 0), fov=1e-4)
GLOW = h.thing(h.quad((0, 0, -3), (50, 0, 0), (0, 50, 0), name="glow"), Material(name="glow", emission=(1.0, 1.0, 1.0)))


def fog(low, high, transmittance=1.0, name="fog", lobe=None):
    """A wide box that absorbs SIGMA per metre, behind a surface that bends nothing."""
    material = Material(name=name, lobes=(lobe or Transparent(h.grey(transmittance)),), medium=Medium(absorption=tuple(SIGMA)))
    return h.thing(h.box((-4, -4, low), (4, 4, high), name=name), material)


def seen(objects, lights=(), world=0.0, **settings):
    """(3,) of the middle of the picture."""
    settings = h.settings(**{"width": 2, "height": 2, "samples": 1} | settings)
    return h.pixels(h.scene(objects, lights, DOWN, world), settings).mean(axis=(1, 2), dtype=np.float64)


@pytest.mark.parametrize("integrator", ["path", "whitted"])
def test_fog_absorbs_inside_of_its_boundary_only(integrator):
    """Beer's law over two bodies of 2 and 1 m, through 4 boundaries, with a clear sheet in one and one between them."""
    half = Material(name="half", lobes=(Transparent((0.5, 0.5, 0.5)),))
    sheets = [h.thing(h.quad((0, 0, z), (6, 0, 0), (0, 6, 0), name=f"{z}"), half) for z in (0, 2)]
    bodies = [fog(-1, 1, TINT), fog(3, 4, TINT)]
    assert seen([GLOW, *bodies, *sheets], integrator=integrator) == pytest.approx(0.25 * TINT**4 * np.exp(-3 * SIGMA), rel=1e-4)


def test_lamps_in_and_behind_fog_are_weakened_on_the_way_in_it():
    upwards = h.frame_towards((0, 0, -1))
    lamps = [
        AreaLight(name=f"{z}", world_from_light=h.affine(upwards, (0, 0, z)), radiance=(L,) * 3, is_visible=True)
        for z, L in ((3.0, 1.0), (0.5, 8.0), (-2.0, 64.0))
    ]
    expected = 1 + 8 * TINT * np.exp(-0.5 * SIGMA) + 64 * TINT**2 * np.exp(-2 * SIGMA)
    assert seen([fog(-1, 1, TINT)], lamps) == pytest.approx(expected, rel=1e-4)


def patch_below(objects, lights):
    """Irradiance (3,) of a white patch, seen from below the objects."""
    image = h.pixels(h.receiver(lights, objects, distance=0.3, tilt=0.5), h.settings(max_depth=0, samples=16))
    return image.mean(axis=(1, 2), dtype=np.float64) * math.pi


LAMP = PointLight(position=(0.0, 0.0, 4.0), intensity=(16.0,) * 3)


def test_shadow_rays_are_absorbed_in_fog_and_not_beside_it():
    assert patch_below([fog(0.5, 2, TINT)], [LAMP]) == pytest.approx(TINT**2 * np.exp(-1.5 * SIGMA), rel=1e-4)


def test_shadow_rays_through_tinted_glass_are_absorbed_in_it():
    """The semi-transparent glass of Whitted's integrator, and what it is filled with."""
    glass = fog(0.5, 2, lobe=Dielectric(1.5, transmittance=tuple(TINT)))
    scene = h.receiver([LAMP], [glass], distance=0.3, tilt=0.5)
    values = h.pixels(scene, h.settings(max_depth=0, samples=1, integrator="whitted")).mean(axis=(1, 2), dtype=np.float64) * math.pi
    assert values == pytest.approx(TINT**2 * np.exp(-1.5 * SIGMA), rel=1e-4)


def test_fog_catches_boundaries_that_are_not_counted(monkeypatch):
    monkeypatch.setattr(media, "pass_boundary", lambda plan, rays, surface: None)
    with pytest.raises(AssertionError):
        test_fog_absorbs_inside_of_its_boundary_only("path")
    with pytest.raises(AssertionError):
        test_shadow_rays_are_absorbed_in_fog_and_not_beside_it()


def test_fog_catches_ways_measured_from_the_origin(monkeypatch):
    monkeypatch.setattr("glanz.engine.plan._BEYOND", {})
    with pytest.raises(AssertionError):
        test_fog_absorbs_inside_of_its_boundary_only("path")
    with pytest.raises(AssertionError):
        test_lamps_in_and_behind_fog_are_weakened_on_the_way_in_it()


def test_a_sheet_that_moves_away_weakens_light_while_it_is_there():
    """Half of the time over the patch, for shadow rays and for camera rays."""
    away = np.stack([h.affine(translation=(x, 0, 0)) for x in (2.0, -8.0)])
    sheet = h.Object(
        name="sheet",
        mesh=h.quad((0, 0, 1), (6, 0, 0), (0, 6, 0)),
        materials=(Material(name="s", lobes=(Transparent(tuple(TINT)),)),),
        world_from_object=away[0],
        motion=away,
    )
    # Its right edge, at x = 5 - 10 t, leaves the patch at t = 0.5 and the camera's ray, at x = 0.1, a little before.
    assert patch_below([sheet], [LAMP]) == pytest.approx(0.5 + 0.5 * TINT, rel=1e-3)
    assert seen([GLOW, sheet], samples=400) == pytest.approx(0.49 * TINT + 0.51, rel=1e-3)
