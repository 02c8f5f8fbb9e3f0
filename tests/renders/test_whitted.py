"""Whitted's recursion against closed forms: slabs, corridors of mirrors, hard shadows, the lecture's illumination model."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, Dielectric, Lambert, Material, Mirror, PerspectiveCamera, Phong, PointLight, SpotLight, SunLight
from glanz.engine.wavefront import branching, hard_light
from glanz.tests import chance, helpers as h

GLASS = Material(name="glass", lobes=(Dielectric(1.5),))
LAMP = Material(name="lamp", emission=(1.0, 1.0, 1.0))
WHITTED = h.settings(width=2, height=2, samples=1, integrator="whitted", max_depth=10)
EYE = (0.05, 0.03, 4.0)


def looking_down(fov=1e-4, target=(0.05, 0.03, 0.0)):
    return PerspectiveCamera.look_at(EYE, target, up=(0, 1, 0), fov=fov)


def slab(lamp_below=True):
    """A camera that looks straight down through a slab of glass; what shines is below it, or above and behind the camera."""
    z = -5.0 if lamp_below else 8.0
    glass = h.thing(h.box((-40, -40, 0), (40, 40, 1)), GLASS)
    return h.scene([glass, h.thing(h.quad((0, 0, z), (200, 0, 0), (0, 200, 0)), LAMP)], camera=looking_down())


def check_slab_in_light():
    """D9: T = (1 - R)^2 (1 + R^2 + R^4 ...) with as many terms as there are bounces for; R = 0.04."""
    for depth, passed in ((1, 0.0), (2, 0.9216), (4, 0.92307456), (6, 0.923076919), (9, 0.9230769231)):
        image = h.pixels(slab(), h.replaced(WHITTED, max_depth=depth))
        np.testing.assert_allclose(image, passed, rtol=2e-6)
    for depth, returned in ((1, 0.04), (3, 0.04 + 0.96**2 * 0.04), (9, 0.0769230769)):
        np.testing.assert_allclose(h.pixels(slab(lamp_below=False), h.replaced(WHITTED, max_depth=depth)), returned, rtol=5e-6)


def test_a_slab_passes_and_returns_light_by_every_round_trip():
    check_slab_in_light()


def test_the_slab_catches_a_refracted_ray_that_is_forgotten(monkeypatch):
    branches = Dielectric.branches
    monkeypatch.setattr(Dielectric, "branches", staticmethod(lambda *args: branches(*args)[:1]))
    with pytest.raises(AssertionError):
        check_slab_in_light()


@pytest.mark.parametrize("precision", ["fast", "exact"])
@pytest.mark.parametrize("integrator", ["whitted", "path", "distributed"])
@pytest.mark.parametrize("r", [1.0, 0.999])
def test_a_corridor_of_mirrors_dims_with_every_reflection(integrator, r, precision):
    """F5: L r^k after k = 1,000 reflections, counted by unfolding the corridor; and no limit to the recursion."""
    mirror = Material(name="mirror", lobes=(Mirror((r, r, r)),))
    length, slope = 10.0, 100.02
    walls = [h.thing(h.quad((length / 2, y, 0), (2 * length, 0, 0), (0, 0, 4)), mirror) for y in (-0.5, 0.5)]
    end = h.thing(h.quad((length, 0, 0), (0, 1, 0), (0, 0, 4)), LAMP)
    camera = PerspectiveCamera.look_at((0, 0, 0.1), (1, slope, 0.1), fov=1e-7)
    scene = h.scene([*walls, end], camera=camera)
    k = math.floor(length * slope + 0.5)
    assert k == 1000
    settings = h.replaced(WHITTED, integrator=integrator, max_depth=1100, precision=precision)
    # In float32 0.999 is 2e-8 off, and so its power 2e-5: what is asked of 1,000 products is the power of the reflectance that they have.
    image = h.pixels(scene, settings)
    np.testing.assert_allclose(image, float(settings.real(r)) ** k, rtol=(2e-6 if precision == "fast" else 2**-24) if r < 1 else 0)
    np.testing.assert_allclose(image, r**k, rtol=3e-5)
    assert not h.pixels(scene, h.replaced(settings, max_depth=k - 2)).any()


def test_rays_that_would_count_less_than_the_limit_are_not_followed():
    """epsilon_r: between two mirrors of 1/2 that face each other, of 1/2, 1/4, 1/8, ... those of at least the limit remain."""
    mirror = Material(name="mirror", lobes=(Mirror((0.5, 0.5, 0.5)),), emission=(1.0, 1.0, 1.0))
    walls = [h.thing(h.quad((0, 0, z), (90, 0, 0), (0, 90, 0)), mirror) for z in (0.0, 5.0)]
    scene = h.scene(walls, camera=looking_down())
    for limit, terms in ((0.0, 11), (0.3, 2), (0.25, 3), (0.1, 4)):
        image = h.pixels(scene, h.replaced(WHITTED, min_contribution=limit))
        np.testing.assert_allclose(image, sum(0.5**k for k in range(terms)), rtol=1e-6)


# Direct light


LIGHTS = [
    PointLight(name="point", position=(1.0, 2.0, 3.0), intensity=(20.0, 10.0, 5.0)),
    SpotLight(name="spot", world_from_light=h.affine(h.frame_towards((0.2, 0.1, 1.0)), (0.5, 0.5, 3.0)), intensity=(9.0,) * 3, angle=1.5),
    SunLight(name="sun", towards=(0.6, 0.0, 0.8), irradiance=(2.0, 2.0, 3.0)),
]


def dull_and_glossy():
    """A floor and balls of Lambert and Phong lobes under lights without a size."""
    glossy = Material(name="glossy", lobes=(Lambert((0.3, 0.4, 0.2)), Phong((0.5, 0.4, 0.3), 30.0)))
    return [
        h.thing(h.quad((0, 0, 0), (8, 0, 0), (0, 8, 0), name="floor"), h.lambert((0.7, 0.6, 0.5))),
        h.thing(h.icosphere(2, 0.8, (-0.7, 0.2, 0.8), smooth=True, name="ball"), glossy),
        h.thing(h.box((0.3, -1.0, 0.0), (1.0, -0.3, 0.7)), h.lambert((0.2, 0.5, 0.8))),
    ]


def check_three_integrators_agree():
    """F8: with lights without a size and no bounce nothing but direct light is left, and all integrators compute it."""
    for light in LIGHTS:
        scene = h.scene(dull_and_glossy(), [light], PerspectiveCamera.look_at((3, -4, 2.5), (0, 0, 0.5)))
        settings = h.settings(width=24, height=24, samples=4, max_depth=0, branches=1)
        path, *others = (h.pixels(scene, h.replaced(settings, integrator=key)) for key in ("path", "whitted", "distributed"))
        assert path.max() > 0.01
        for image in others:
            np.testing.assert_allclose(image, path, rtol=1e-6, atol=1e-7)


def test_whitted_distributed_and_path_tracing_agree_on_direct_light():
    check_three_integrators_agree()


def test_agreement_catches_a_cosine_squared(monkeypatch):
    middles = hard_light.to_middles

    def steeper(plan, rays, surface):
        for light, wi, distance, E in middles(plan, rays, surface):
            yield light, wi, distance, E * (surface.ns * wi).sum(axis=0)

    monkeypatch.setattr(hard_light, "to_middles", steeper)
    with pytest.raises(AssertionError):
        check_three_integrators_agree()


def test_lights_add_up():
    """The picture under all lights is the sum of those under each."""
    camera = PerspectiveCamera.look_at((3, -4, 2.5), (0, 0, 0.5))
    together, *alone = (h.pixels(h.scene(dull_and_glossy(), lights, camera), WHITTED) for lights in (LIGHTS, *([one] for one in LIGHTS)))
    assert all(image.any() for image in alone)
    np.testing.assert_allclose(together, sum(alone), rtol=1e-5)


@pytest.mark.parametrize("is_ellipse", [False, True])
def test_an_area_light_is_its_middle(is_ellipse):
    """E = L A cos cos' / d^2 of the whole light at its middle, and shadows without a penumbra."""
    lamp = AreaLight(world_from_light=h.affine(translation=(0, 0, 2)), size_x=0.8, size_y=0.5, is_ellipse=is_ellipse, radiance=(3.0,) * 3)
    for x in (0.0, 1.0):
        scene = h.receiver([lamp], point=(x, 0, 0))
        cos = 2 / math.hypot(2, x)
        truth = 3.0 * lamp.area() * cos * cos / (4 + x * x) / math.pi
        np.testing.assert_allclose(h.pixels(scene, WHITTED), truth, rtol=1e-5)
    # Half a plane at half the height covers the floor on one side of x = 0, with an edge that the lamp's size does not soften.
    cover = h.thing(h.quad((5, 0, 1), (10, 0, 0), (0, 10, 0)), h.lambert(0))
    camera = PerspectiveCamera.look_at((0, 0, 0.9), (0, 0, 0), up=(0, 1, 0), fov=0.6)
    floor = h.thing(h.quad((0, 0, 0), (10, 0, 0), (0, 10, 0)), h.lambert(1.0))
    row = h.pixels(h.scene([floor, cover], [lamp], camera), h.replaced(WHITTED, width=32, height=2))[0, 0]
    assert (row[:16] > 0.05).all()
    assert not row[16:].any()


def test_emissive_patches_shine_from_their_middle():
    """A parallelogram and a triangle above the floor: L A cos^2 / d^2 / pi at the point below their middle."""
    square = h.quad((0, 0, 2), (0.4, 0, 0), (0, -0.3, 0))
    corners = np.array([[-0.3, 0.3, 0.0], [-0.2, -0.2, 0.4], [2.0, 2.0, 2.0]])
    triangle = h.Mesh(name="triangle", vertices=corners, triangles=np.array([[0], [2], [1]]))
    for mesh, area in ((square, 0.12), (triangle, 0.18)):
        scene = h.receiver(objects=[h.thing(mesh, Material(name="glow", emission=(5.0,) * 3))])
        np.testing.assert_allclose(h.pixels(scene, WHITTED), 5.0 * area / 4 / math.pi, rtol=1e-5)


def test_of_very_many_lights_some_are_chosen(monkeypatch):
    """With more lights than are asked one by one the mean stays what it was; detects 2 %."""
    lights = [PointLight(name=str(i), position=(math.cos(i), math.sin(i), 2 + 0.1 * i), intensity=(1.0,) * 3) for i in range(6)]
    scene = h.receiver(lights)
    truth = h.pixels(scene, WHITTED)[0].mean()
    monkeypatch.setattr(hard_light, "MOST_LIGHTS", 3)
    noisy = h.pixels(scene, h.replaced(WHITTED, width=64, height=64, sampler="random"))[0]
    assert noisy.std() > 0
    assert h.mean_is(noisy, truth, floor=1e-5)


# The lecture's illumination model


def illumination(light_falloff, has_shadow=False):
    """The middle pixel of a patch with all terms of the model, seen from 0.5 rad, under two lamps: measured and by hand."""
    material = Material(name="phong", lobes=(Lambert((0.5,) * 3), Phong((0.4,) * 3, 7.0)), ambient=(0.05, 0.1, 0.2))
    places = ((0.0, 0.0, 2.0), (1.0, 0.5, 1.5))
    lamps = [PointLight(position=p, intensity=(c, 2 * c, 3 * c)) for p, c in zip(places, (2.0, 5.0))]
    roof = [h.thing(h.quad((0, 0, 1.2), (9, 0, 0), (0, 9, 0)), h.lambert(0))] if has_shadow else []
    scene = h.receiver(lamps, roof, material=material, tilt=0.5)
    view = np.array([math.sin(0.5), 0, math.cos(0.5)])
    view = h.frame_towards((0, 0, 1)) @ view
    total = np.zeros(3)
    for place, lamp in zip(places, lamps):
        light = np.array(place) / np.linalg.norm(place)
        I_L = np.array(lamp.intensity) / (np.dot(place, place) if light_falloff else 1)
        shade = 0.5 * light[2] + 0.4 * max(np.dot(2 * light[2] * np.array([0, 0, 1]) - light, view), 0) ** 7
        total += I_L * (np.array(material.ambient) + (0 if has_shadow else shade))
    image = h.pixels(scene, h.replaced(WHITTED, integrator="whitted_phong", light_falloff=light_falloff))
    return image[:, 0, 0], total


@pytest.mark.parametrize("light_falloff", [True, False])
@pytest.mark.parametrize("has_shadow", [False, True])
def test_the_illumination_model_is_the_lectures(light_falloff, has_shadow):
    """k_a I_L + k_d I_L (n.l) + k_s I_L (r.v)^n for each light; in shadow k_a I_L alone."""
    measured, truth = illumination(light_falloff, has_shadow)
    np.testing.assert_allclose(measured, truth, rtol=2e-5)


def test_illumination_catches_another_exponent(monkeypatch):
    def sharper(k, n, wo, wi):
        return k.reflectance * h.dots(2 * h.dots(n, wo) * n - wo, wi) ** 7.1

    monkeypatch.setattr(Phong, "illuminate", staticmethod(sharper))
    measured, truth = illumination(True)
    assert np.abs(measured / truth - 1).max() > 1e-3


# Against path tracing


@chance.fresh
def test_mirrors_and_glass_look_as_path_tracing_finds_them():
    """F10: full branching is the expectation of following one branch; detects 3 % at single points of a glass ball."""
    ball = h.thing(h.icosphere(3, 1.0, smooth=True), GLASS)
    mirror = h.thing(h.icosphere(2, 1.0, (2.2, 0, 0), smooth=True), Material(name="m", lobes=(Mirror((0.8, 0.7, 0.6)),)))
    walls = [
        h.thing(h.quad((0, 6, 0), (12, 0, 0), (0, 0, 12), name="a"), Material(name="red", emission=(1.0, 0.2, 0.1))),
        h.thing(h.quad((0, -6, 0), (12, 0, 0), (0, 0, 12), name="b"), Material(name="blue", emission=(0.1, 0.4, 1.0))),
    ]
    for target in ((0.5, 0, 0.3), (-0.8, 0, 0.2), (1.6, 0, 0.4)):
        camera = PerspectiveCamera.look_at((0.4, -5, 0.7), target, fov=1e-6)
        scene = h.scene([ball, mirror, *walls], camera=camera, world=0.3)
        truth = h.pixels(scene, h.replaced(WHITTED, max_depth=12))[:, 0, 0]
        # The last bounce of a path may still see what shines: the same number of scattered rays.
        paths = h.pixels(scene, h.replaced(WHITTED, integrator="path", width=256, height=256, max_depth=11, sampler="random"))
        for channel, value in zip(paths, truth):
            assert h.mean_is(channel, value, floor=1e-4), target
            assert not h.mean_is(channel, 1.03 * value, floor=1e-4), target


def test_siblings_do_not_share_their_random_numbers():
    """A mirrored and a refracted ray of one hit differ in their stream, their descendants too."""
    streams = {0}
    for _ in range(4):
        streams |= {int(branching.mix_int(stream + i)) for stream in streams for i in (1, 2)}
    assert len(streams) == 31
