"""Direct light where it is hardest: the rim of the sun's shadow, lights that touch, lights seen by detours (catalogue E3, E6, E10, E13)."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, Dielectric, Material, Mirror, PerspectiveCamera, PointLight, SpotLight, SunLight
from glanz.engine.constants import EPS32
from glanz.engine.world import interaction
from glanz.tests import chance, helpers as h
from glanz.tests.polygons import polygon_irradiance

SUN = math.radians(0.533)
PIXELS = 40
HALF = 0.01
"""Half the width that is looked at [m]; the penumbra of an edge 1 m high is 0.009303 m wide."""


def rim(angle=SUN):
    """Irradiance along x under a sun straight above, an edge at x = 0 and 1 m above; of the whole light 1."""
    cover = h.thing(h.quad((50, 0, 1), (100, 0, 0), (0, 900, 0)), h.lambert(0))
    floor = h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)), h.lambert(1.0))
    camera = PerspectiveCamera.look_at((0, 0, 0.9), (0, 0, 0), up=(0, 1, 0), fov=2 * math.atan(HALF / 0.9))
    scene = h.scene([floor, cover], [SunLight(angle=angle)], camera)
    image = h.pixels(scene, h.settings(width=PIXELS, height=PIXELS, samples=256, max_depth=0, sampler="sobol"))
    return np.pi * image[0].mean(axis=0, dtype=np.float64)


def rim_truth():
    """The part of a disk of radius tan(a) on one side of a chord at x: (acos c - c sqrt(1 - c^2)) / pi, averaged over pixels."""
    x = (np.arange(PIXELS * 64) + 0.5) / (PIXELS * 64) * 2 * HALF - HALF
    c = np.clip(x / math.tan(SUN / 2), -1, 1)
    return ((np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi).reshape(PIXELS, 64).mean(axis=1)


def check_rim(values):
    truth = rim_truth()
    # Full and black to the pixel beside the border: 2 h tan(a) wide.
    assert (values[truth == 0] == 0).all()
    np.testing.assert_allclose(values[truth > 1 - 1e-12], 1, rtol=1e-5)
    # 40 rows of 256 samples: noise of 0.3 % at most.
    np.testing.assert_allclose(values, truth, atol=0.01)


def test_the_suns_shadow_has_a_rim_as_wide_as_its_disk():
    """E3: 2 h tan(.2665 degrees) = .009303 h; detects an angle that is off by 3 %."""
    assert (rim_truth() == 0).sum() == (rim_truth() > 1 - 1e-12).sum() == 10
    check_rim(rim())


def test_the_rim_catches_another_sun():
    for angle in (0.0, 0.95 * SUN, 1.05 * SUN):
        with pytest.raises(AssertionError):
            check_rim(rim(angle))


@pytest.mark.parametrize("ratio", [1e-6, 1e-4, 0.99, 1 - 1e-6])
@chance.fresh
def test_an_emissive_sphere_far_away_and_all_but_touching(ratio):
    """E6 at its ends: the sum over the visible triangles of a sphere of 80, R / d from 1e-6 to where it all but touches; detects 2 %."""
    mesh = h.icosphere(1, ratio, (0, 0, 1))
    truth = 0.0
    for corners in mesh.vertices.astype(float)[:, mesh.triangles].transpose(2, 1, 0):
        if np.cross(corners[1] - corners[0], corners[2] - corners[0]) @ corners[0] < 0:
            truth += polygon_irradiance(corners, (0, 0, 0), (0, 0, 1))
    distance = 0.5 * (1 - ratio)
    scene = h.receiver(objects=[h.thing(mesh, h.lambert(0, "lamp", 1.0))], distance=distance, size=0.01 * distance)
    values = math.pi * h.pixels(scene, h.settings(samples=2048, max_depth=0))[0].astype(np.float64)
    assert h.mean_is(values, truth, floor=1e-5)
    assert not h.mean_is(1.02 * values, truth, floor=1e-5)


@pytest.mark.parametrize("height", [1e-3, 1e-4, 1e-5, 1e-6])
@chance.fresh
def test_a_light_that_all_but_lies_on_its_receiver_is_the_whole_sky(height):
    """E10: pi L in the limit, to h^2; detects 0.3 %."""
    near = AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, height)))
    values = math.pi * h.pixels(h.receiver([near], distance=0.5), h.settings(samples=256, max_depth=0))[0].astype(np.float64)
    assert h.mean_is(values, math.pi, floor=1e-4)
    assert not h.mean_is(0.997 * values, math.pi, floor=1e-4)


LIGHTS = {
    "area": AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 3)), size_x=4.0, size_y=4.0, radiance=(3.0, 2.0, 1.0)),
    "bulb": PointLight(position=(0, 0, 3), radius=1.0, intensity=(3 * math.pi, 2 * math.pi, math.pi)),
    "ball": PointLight(position=(0, 0, 3), radius=1.0, intensity=(3 * math.pi, 2 * math.pi, math.pi), soft_falloff=False),
    "spot": SpotLight(
        world_from_light=h.affine(np.eye(3), (0, 0, 3)), radius=1.0, intensity=(3 * math.pi, 2 * math.pi, math.pi), blend=0.0
    ),
    "sun": SunLight(towards=(0, 0, 1), angle=0.2, irradiance=tuple(math.pi * math.sin(0.1) ** 2 * x for x in (3.0, 2.0, 1.0))),
    "mesh": h.thing(h.quad((0, 0, 3), (4, 0, 0), (0, 4, 0), name="glow"), h.lambert(0, "glow", (3.0, 2.0, 1.0))),
}


def seen(name, between, **changes):
    light = LIGHTS[name]
    objects, lights = ([light], []) if name == "mesh" else ([], [light])
    camera = PerspectiveCamera.look_at((0.1, 0.2, 1), (0.1, 0.2, 0 if between == "mirror" else 2), up=(0, 1, 0), fov=0.02)
    if between == "mirror":
        objects.append(h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), Material(name="m", lobes=(Mirror((0.9, 0.5, 0.25)),))))
    else:
        objects.append(h.thing(h.box((-2, -2, 1.5), (2, 2, 1.6)), Material(name="g", lobes=(Dielectric(1.5),))))
    return h.pixels(h.scene(objects, lights, camera), h.settings(max_depth=4, **changes))


@pytest.mark.parametrize("integrator", ["path", "path_blind", "distributed", "whitted"])
@pytest.mark.parametrize("name", LIGHTS)
def test_a_light_in_a_mirror_has_its_radiance_times_the_reflectance(name, integrator):
    """E13: r L in every sample, to 1e-6."""
    truth = np.array((3.0 * 0.9, 2.0 * 0.5, 1.0 * 0.25))[:, None, None]
    image = seen(name, "mirror", integrator=integrator)
    np.testing.assert_allclose(image, np.broadcast_to(truth, image.shape), rtol=2e-6)


@pytest.mark.parametrize("name", LIGHTS)
def test_a_light_through_a_pane_has_its_radiance_times_what_passes(name):
    """E13 straight on: (1 - R)^2 (1 + R^2) L within four bounces, R = 0.04, by Whitted's rays, without chance; to 1e-4 of angles."""
    truth = 0.96**2 * (1 + 0.04**2) * np.array((3.0, 2.0, 1.0))[:, None, None]
    image = seen(name, "pane", integrator="whitted")
    np.testing.assert_allclose(image, np.broadcast_to(truth, image.shape), rtol=1e-4)


@pytest.mark.parametrize("gap", [1e-1, 1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("angle", [0.0, 1.0, 1.5])
def test_a_bulb_close_to_a_wall_is_off_by_what_rays_start_off_it_and_no_more(gap, angle):
    """F3, E1 for a lamp d from a wall: I cos^3 / d^2 to a relative 2 h / d; detects twice that.

    Light is seen from where its shadow ray starts, h = 8 * 2^-24 (C + X) off a wall of extent X at the coordinates C: up to 4e-6 m
    in this room. So 1e-6 m from a wall of metres, as F3 has it, is not met: a lamp so near is a part of its wall.
    """
    lamp = PointLight(position=(0.3, 0.2, gap))
    x = 0.3 + gap * math.tan(angle)
    camera = PerspectiveCamera.look_at((x, 0.2, gap), (x, 0.2, 0), up=(0, 1, 0), fov=1e-4)
    room = h.scene([h.thing(h.box((-2, -2, 0), (2, 2, 4)))], [lamp], camera)
    image = h.pixels(room, h.settings(max_depth=0))
    start = interaction.START_ULPS * EPS32 * (4 + 4)
    np.testing.assert_allclose(image, 0.5 / math.pi * math.cos(angle) ** 3 / gap**2, rtol=2 * start / gap + 1e-5)
