"""Pictures of a white patch under each light against its irradiance in closed form (catalogue E1-E6, E10, E11, E13).

Each picture is 8 x 8 pixels that see one point: where no random number matters every pixel must be right to 1e-5
(float32), else their mean, by Student's t at 1e-6.
"""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, Lambert, Material, Phong, PointLight, SpotLight, SunLight
from glanz.engine.wavefront import direct
from glanz.engine.world.lights import Lights
from glanz.tests import chance, helpers as h
from glanz.tests.polygons import polygon_irradiance

SQUARE = 0.752274688
OVERHEAD = h.affine(np.eye(3), (0, 0, 1))
POINT = PointLight(position=(1.0, 2.0, 2.0), intensity=(3.0, 2.0, 1.0))
SPOT = SpotLight(world_from_light=h.affine(h.frame_towards((1, 2, 2)), (1, 2, 2)), intensity=(3.0, 2.0, 1.0), angle=1.0)
COLOUR = np.array((3.0, 2.0, 1.0))

EXACT = {
    "point": (POINT, COLOUR / 9 * 2 / 3),
    "spot on its axis": (SPOT, COLOUR / 9 * 2 / 3),
    "spot that looks past": (h.replaced(SPOT, world_from_light=h.affine(np.eye(3), (2, 0, 1))), 0 * COLOUR),
    "sun": (SunLight(towards=(0.6, 0.0, 0.8), irradiance=(3.0, 2.0, 1.0)), 0.8 * COLOUR),
    "sun below": (SunLight(towards=(0.6, 0.0, -0.8), irradiance=(3.0, 2.0, 1.0)), 0 * COLOUR),
    "point below": (PointLight(position=(0.0, 0.0, -1.0)), 0 * COLOUR),
}
NOISY = {
    "soft bulb": (PointLight(position=(0.0, 0.0, 2.0), radius=1.0), 1 / 5),
    "ball": (PointLight(position=(0.0, 0.0, 2.0), radius=1.0, soft_falloff=False), 1 / 4),
    "inside a ball": (PointLight(position=(0.0, 0.0, 1.0), radius=2.0, soft_falloff=False), 1 / 4),
    "wide sun": (SunLight(towards=(0.6, 0.0, 0.8), angle=0.5), 0.8),
    "half the sky": (SunLight(angle=math.pi), 1.0),
    "square": (AreaLight(world_from_light=OVERHEAD), SQUARE),
    "disk": (AreaLight(world_from_light=OVERHEAD, size_x=2.0, size_y=2.0, is_ellipse=True), math.pi / 2),
    "square that faces away": (AreaLight(world_from_light=h.affine(np.diag((1.0, -1, -1)), (0, 0, 1))), 0.0),
    "spread": (
        AreaLight(world_from_light=OVERHEAD, size_x=1e-5, size_y=1e-5, spread=math.radians(60), radiance=(1e10,) * 3),
        math.tan(math.radians(30)) / (math.tan(math.radians(30)) - math.radians(30)),
    ),
}


def irradiances(scene, samples=64, **changes):
    """Irradiance (3, 64) that each pixel tells; bounces do not matter before a convex patch."""
    image = h.pixels(scene, h.settings(samples=samples, **{"max_depth": 0, **changes}))
    return image.reshape(3, -1).astype(np.float64) * math.pi


@pytest.mark.parametrize("name", EXACT)
def test_lights_without_a_size_give_the_closed_form_in_every_pixel(name):
    """E1-E3; detects 1e-5."""
    light, truth = EXACT[name]
    values = irradiances(h.receiver([light]), samples=2)
    np.testing.assert_allclose(values, np.broadcast_to(truth[:, None], values.shape), rtol=1e-5, atol=1e-12)


@pytest.mark.parametrize("name", NOISY)
@chance.fresh
def test_lights_with_a_size_give_the_closed_form_on_average(name):
    """E4 and its kin; detects 0.3 %."""
    light, truth = NOISY[name]
    values = irradiances(h.receiver([light], distance=0.5))
    assert h.mean_is(values[1], truth, floor=1e-5)
    assert values.std(axis=1).max() <= 0.2 * max(truth, 1e-9)


def test_the_closed_form_catches_a_percent_and_a_lost_weight(monkeypatch):
    light, truth = NOISY["square"]
    values = irradiances(h.receiver([light], distance=0.5))
    assert not h.mean_is(1.01 * values[1], truth, floor=1e-5)
    monkeypatch.setattr(direct, "power_heuristic", lambda pdf, other: np.float32(0.5))
    assert not h.mean_is(irradiances(h.receiver([light], distance=0.5))[1], truth, floor=1e-5)


def test_a_reflectance_below_one_reflects_that_much():
    """E1 as in the catalogue: k_d / pi I cos / d^2 = 1.989436789."""
    light = PointLight(position=tuple(2 * h.at_angle(math.radians(60)).ravel()), intensity=(100.0,) * 3)
    image = h.pixels(h.receiver([light], material=h.lambert(0.5)), h.settings(max_depth=0))
    np.testing.assert_allclose(image, 1.989436789, rtol=1e-5)


@pytest.mark.parametrize("tilt", [0.3, 1.2, 1.5])
def test_diffuse_light_does_not_depend_on_where_it_is_seen_from(tilt):
    values = irradiances(h.receiver([POINT], tilt=tilt), samples=2)
    np.testing.assert_allclose(values, np.broadcast_to(EXACT["point"][1][:, None], values.shape), rtol=1e-4)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
@chance.fresh
def test_closed_forms_hold_at_every_scale(scale):
    light = PointLight(position=tuple(scale * np.array((1.0, 2.0, 2.0))), intensity=tuple(scale**2 * COLOUR))
    values = irradiances(h.receiver([light], size=0.01 * scale, distance=scale), samples=2)
    np.testing.assert_allclose(values, np.broadcast_to(EXACT["point"][1][:, None], values.shape), rtol=1e-5)
    light = AreaLight(world_from_light=h.affine(scale * np.eye(3), (0, 0, scale)))
    assert h.mean_is(irradiances(h.receiver([light], size=0.01 * scale, distance=0.5 * scale))[0], SQUARE, floor=1e-5)


def emissive(mesh, radiance=1.0):
    return h.thing(mesh, h.lambert(0, "lamp", radiance))


@chance.fresh
def test_an_emissive_square_gives_what_an_area_light_gives():
    values = irradiances(h.receiver(objects=[emissive(h.quad((0, 0, 1)))], distance=0.5))
    assert h.mean_is(values[0], SQUARE, floor=1e-5)


@chance.fresh
def test_an_emissive_polygon_is_cut_off_at_the_horizon():
    """E5 with the receiver tilted until the polygon sinks into its plane; detects 0.5 %."""
    corners = np.array([(0.5, -0.4, 0.3), (1.0, 0.5, -0.3), (0.8, 0.8, 0.6), (0.3, 0.2, 0.9)])
    a, b, c = corners[:3]
    corners[3] = a + (c - a) * 0.4 + (a - b) * 0.5  # in the plane of the others
    mesh = h.Mesh(name="polygon", vertices=corners.T, triangles=np.array([[0, 1, 2], [0, 2, 3]]).T)
    truth = polygon_irradiance(corners, (0, 0, 0), (0, 0, 1))
    assert truth > 0.05
    values = irradiances(h.receiver(objects=[emissive(mesh)], distance=0.2), samples=256)
    assert h.mean_is(values[0], truth, floor=1e-5)


@pytest.mark.parametrize("ratio", [0.1, 1 / 3, 0.9])
@chance.fresh
def test_an_emissive_sphere_gives_the_sum_over_its_visible_triangles(ratio):
    """E6: a sphere of 80 triangles against its own polygons, hidden ones left out by their normals; detects 2 %.

    The round sphere would give pi (R / d)^2; the mesh is smaller by a few percent, so that is only a bound.
    """
    mesh = h.icosphere(1, ratio, (0, 0, 1))
    truth = 0.0
    for corners in mesh.vertices.astype(float)[:, mesh.triangles].transpose(2, 1, 0):
        if np.cross(corners[1] - corners[0], corners[2] - corners[0]) @ corners[0] < 0:
            truth += polygon_irradiance(corners, (0, 0, 0), (0, 0, 1))
    assert 0.85 * math.pi * ratio**2 < truth < math.pi * ratio**2
    distance = 0.5 * (1 - ratio)
    values = irradiances(h.receiver(objects=[emissive(mesh)], distance=distance, size=0.01 * distance), samples=2048)
    assert h.mean_is(values[0], truth, floor=1e-5)
    assert not h.mean_is(1.02 * values[0], truth, floor=1e-5)


@pytest.mark.parametrize("count", [2, 5, 16, 17, 40])
@pytest.mark.parametrize("kind", ["area", "point", "mesh"])
@chance.fresh
def test_light_does_not_depend_on_how_many_it_is_divided_among(count, kind):
    """E12: n lights of one n-th each; detects 2 %. Beyond 16 lamps, and 32 lights to choose among, other code runs."""
    lights, objects = [], []
    for i in range(count):
        if kind == "area":
            lights.append(AreaLight(name=f"{i}", world_from_light=OVERHEAD, radiance=(1 / count,) * 3))
        elif kind == "point":
            lights.append(PointLight(name=f"{i}", position=(0.0, 0.0, 2.0), intensity=(1 / count,) * 3, radius=1.0))
        else:  # strips of one square
            y = (i + 0.5) / count - 0.5
            objects.append(emissive(h.quad((0, y, 1), (1, 0, 0), (0, 1 / count, 0), name=f"{i}")))
    truth = {"area": SQUARE, "point": 1 / 5, "mesh": SQUARE}[kind]
    values = irradiances(h.receiver(lights, objects, distance=0.5), samples=512)
    assert h.mean_is(values[0], truth, floor=1e-5)
    assert not h.mean_is(1.02 * values[0], truth, floor=1e-5)


def test_counting_catches_shadow_rays_that_share_with_nobody(monkeypatch):
    """The mutant weighs shadow rays as if dull surfaces' rays looked for the lamps, beyond the 16 for which they do."""
    lights = [AreaLight(name=f"{i}", world_from_light=OVERHEAD, radiance=(1 / 17,) * 3) for i in range(17)]
    scene = h.receiver(lights, distance=0.5)
    monkeypatch.setattr(Lights, "rival", lambda self, index, pdf: pdf)
    assert not h.mean_is(irradiances(scene, samples=1024)[0], SQUARE, floor=0.01)


def test_strong_and_weak_lights_of_different_kinds_add_up():
    """The sum of pictures is the picture of the sum; detects 2 %. The weak one is a thousandth."""
    lights = [
        POINT,
        SunLight(irradiance=(1e-3,) * 3),
        AreaLight(world_from_light=OVERHEAD),
        PointLight(position=(0.0, -1.0, 1.0), intensity=(0.1,) * 3),
    ]
    truth = EXACT["point"][1][0] + 1e-3 + SQUARE + 0.1 / 2 / math.sqrt(2)
    values = irradiances(h.receiver(lights, distance=0.5), samples=256)
    assert h.mean_is(values[0], truth, floor=1e-5)


def test_a_weak_light_is_seen_where_the_strong_one_is_hidden():
    """The strong bulb stands behind a shade that its own light cannot pass; detects 20 % of what the weak one gives."""
    shade = h.thing(h.box((-0.3, -0.3, 0.5), (0.3, 0.3, 0.6), name="shade"), h.lambert(0))
    strong = PointLight(name="strong", position=(0.0, 0.0, 1.0), intensity=(1e3,) * 3)
    weak = PointLight(name="weak", position=(2.0, 0.0, 1.0), intensity=(1.0,) * 3)
    values = irradiances(h.receiver([strong, weak], [shade], distance=0.3), samples=2048)
    assert h.mean_is(values[0], 1 / 5 / math.sqrt(5), floor=1e-5)
    assert values.std() > 0


def test_shadows_are_black():
    """An object between the light and the patch; also where the light has a size, and for the sun."""
    blocker = h.thing(h.quad((0, 0, 0.8), (4, 0, 0), (0, 4, 0), name="blocker"), h.lambert(0))
    for light in (POINT, SPOT, AreaLight(world_from_light=OVERHEAD), SunLight(towards=(0.0, 0.0, 1.0), angle=0.1)):
        assert irradiances(h.receiver([light], [blocker], distance=0.5)).max() == 0


def test_light_objects_cast_no_shadow():
    """A light in front of another hides nothing: it is no mesh."""
    lights = [AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 0.7)), radiance=(0.0,) * 3), AreaLight(world_from_light=OVERHEAD)]
    assert h.mean_is(irradiances(h.receiver(lights, distance=0.5))[0], SQUARE, floor=1e-5)


@chance.fresh
def test_half_of_a_light_behind_an_edge_gives_half():
    """A square light seen past a wall that covers half of it; detects 1 %."""
    wall = h.thing(h.quad((5, 0, 0.75), (10, 0, 0), (0, 10, 0), name="wall"), h.lambert(0))
    values = irradiances(h.receiver([AreaLight(world_from_light=OVERHEAD)], [wall], distance=0.5), samples=256)
    assert h.mean_is(values[0], SQUARE / 2, floor=1e-3)


@pytest.mark.parametrize("visible", [True, False])
@pytest.mark.parametrize(
    "light",
    [
        AreaLight(size_x=4.0, size_y=4.0, radiance=(3.0, 2.0, 1.0)),
        PointLight(radius=1.0, intensity=tuple(math.pi * COLOUR)),
        PointLight(radius=1.0, intensity=tuple(math.pi * COLOUR), soft_falloff=False),
        SpotLight(radius=1.0, intensity=tuple(math.pi * COLOUR), blend=0.0, world_from_light=np.eye(4)),
        SunLight(towards=(0.0, 0.0, 1.0), angle=0.2, irradiance=tuple(math.pi * math.sin(0.1) ** 2 * COLOUR)),
    ],
    ids=lambda x: x.key,
)
def test_a_light_that_is_seen_has_its_radiance_and_one_that_is_not_has_none(light, visible):
    """E13: looking straight up at it from 2 m below."""
    light = h.replaced(light, is_visible=visible)
    camera = h.PerspectiveCamera.look_at((0, 0, -2), (0, 0, 0), up=(0, 1, 0), fov=0.05)
    image = h.pixels(h.scene(lights=[light], camera=camera), h.settings())
    np.testing.assert_allclose(image, np.broadcast_to((COLOUR * visible)[:, None, None], image.shape), rtol=1e-5)


def test_an_emissive_surface_that_is_seen_has_its_radiance_on_both_sides():
    """E13: exactly L, before and behind, whatever it reflects."""
    for z in (3, -3):
        camera = h.PerspectiveCamera.look_at((0.1, 0.2, z), (0, 0, 0), up=(0, 1, 0), fov=0.05)
        image = h.pixels(h.scene([h.thing(h.quad(), h.lambert(0, emission=(3, 2, 1)))], camera=camera), h.settings())
        assert (image == COLOUR[:, None, None].astype(np.float32)).all()


def test_light_that_touches_its_receiver_stays_finite():
    """E10: a square light lying on the patch, crossing it, and standing in it: finite, and at most pi L."""
    for matrix in (
        h.affine(np.eye(3), (0, 0, 1e-6)),
        h.affine(h.frame_towards((0, 1, 1))),
        h.affine(h.frame_towards((0, 1, 0))),
        np.eye(4),
    ):
        values = irradiances(h.receiver([AreaLight(world_from_light=matrix)], distance=0.5), samples=64)
        assert np.isfinite(values).all()
        assert values.mean() <= math.pi * 1.2
    # Close above it is the whole sky: detects 1 %.
    near = AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 1e-3)))
    assert h.mean_is(irradiances(h.receiver([near], distance=0.5), samples=256)[0], math.pi, floor=1e-3)


def test_a_bulb_on_its_receiver_stays_finite():
    for light in (PointLight(), PointLight(radius=0.1), PointLight(radius=0.1, soft_falloff=False), SpotLight(), SpotLight(radius=0.1)):
        image = h.pixels(h.receiver([light]), h.settings(max_depth=1))
        assert np.isfinite(image).all()
        assert (image >= 0).all()


@pytest.mark.parametrize(
    "light", [AreaLight(size_x=0.0), PointLight(intensity=(0.0,) * 3), SunLight(irradiance=(0.0,) * 3), AreaLight(radiance=(0.0,) * 3)]
)
def test_lights_without_area_or_power_give_nothing(light):
    """E11: alone and beside another."""
    assert irradiances(h.receiver([light])).max() == 0
    values = irradiances(h.receiver([light, POINT]), samples=2)
    np.testing.assert_allclose(values, np.broadcast_to(EXACT["point"][1][:, None], values.shape), rtol=1e-5)


def tilted_patch(angle):
    """A patch whose shading normals lean by `angle` towards +x."""
    flat = h.quad((0, 0, 0), (0.01, 0, 0), (0, 0.01, 0), name="leaning")
    normals = np.repeat(h.at_angle(angle), 4, 1)
    return h.Mesh(name=flat.name, vertices=flat.vertices, triangles=flat.triangles, normals=normals, normal_indices=flat.triangles)


@pytest.mark.parametrize("angle", [0.5, 1.2, 1.5])
@pytest.mark.parametrize("material", [h.lambert(1.0), Material(name="shiny", lobes=(Phong((1.0,) * 3, 20.0),))], ids=lambda m: m.name)
def test_leaning_normals_let_no_light_through(angle, material):
    """C11: light from below the facet is none, though it is above the leaning normal; from above it counts by that normal."""
    base = h.receiver(material=material)
    patch = h.thing(tilted_patch(angle), material)
    below = PointLight(position=tuple((2 * h.at_angle(math.pi / 2 + 0.2)).ravel()))
    for way in ({"max_depth": 0}, {"max_depth": 3}):
        assert h.pixels(h.replaced(base, objects=[patch], lights=[below]), h.settings(**way)).max() == 0
    if material.name == "diffuse":
        above = PointLight(position=tuple((2 * h.at_angle(1.0)).ravel()))
        image = h.pixels(h.replaced(base, objects=[patch], lights=[above]), h.settings(max_depth=0))
        np.testing.assert_allclose(image, math.cos(1.0 - angle) / 4 / math.pi, rtol=1e-5)


@pytest.mark.parametrize("angle", [1.5, 1.6, 3.0])
def test_normals_that_lean_past_the_view_give_no_nan(angle):
    """C11: seen from the far side of its own normal, in a world of light: finite, and not brighter than the world."""
    for material in (h.lambert(1.0), Material(name="shiny", lobes=(Phong((1.0,) * 3, 20.0),))):
        scene = h.replaced(
            h.receiver(material=material, tilt=-1.2), objects=[h.thing(tilted_patch(angle), material)], world=h.World(radiance=(1.0,) * 3)
        )
        image = h.pixels(scene, h.settings(samples=64, max_depth=2))
        assert np.isfinite(image).all()
        assert image.min() >= 0
        assert image.mean() <= 1.001


def test_black_reflects_nothing():
    """F13: no lobe, a lobe of 0, and a channel of 0."""
    for material in (Material(name="none"), Material(name="zero", lobes=(Lambert((0.0, 0.0, 0.0)),))):
        assert irradiances(h.receiver([POINT], material=material)).max() == 0
    values = irradiances(h.receiver([POINT], material=Material(name="red", lobes=(Lambert((1.0, 0.0, 0.0)),))))
    assert values[0].min() > 0
    assert values[1:].max() == 0
