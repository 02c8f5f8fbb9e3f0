"""What cannot be rendered is refused or left out, and always named (faults J13-J18)."""

import math

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    CheckerTexture,
    Dielectric,
    EnvironmentMap,
    Lambert,
    Material,
    Medium,
    PerspectiveCamera,
    Phong,
    PointLight,
    SceneError,
    SceneWarning,
    Settings,
    SpotLight,
    SunLight,
    World,
    prepare,
    render,
    render_image,
)
from glanz.engine.scene.validate import validate
from glanz.tests import helpers as h

SETTINGS = h.settings(samples=1, max_depth=1)
GREY = np.full((3, 2, 4), 0.5, np.float32)


def under(pixels=GREY, **changes):
    return h.replaced(h.scene(), world=World(name="Sky", environment=EnvironmentMap(pixels=pixels, **changes)))


def holed(*values):
    pixels = GREY.copy()
    pixels[1, 0, : len(values)] = values
    return pixels


def wears(**material):
    return h.scene([h.Object(name="chair", mesh=h.quad(), materials=(Material(name="wood", **material),))])


REFUSED = {
    "no camera": (h.replaced(h.scene(), camera=None, name="Shot"), "scene 'Shot' has no camera"),
    "something else as camera": (h.replaced(h.scene(), camera=PointLight()), "scene 'Scene': PointLight is not a camera"),
    "camera that is not finite": (
        h.scene(camera=PerspectiveCamera(name="Eye", world_from_camera=h.affine(translation=(np.nan, 0, 0)))),
        "camera 'Eye': its transform is not finite or flattens space",
    ),
    "flat camera": (
        h.scene(camera=PerspectiveCamera(name="Eye", world_from_camera=h.affine(np.diag((1.0, 1, 0))))),
        "camera 'Eye': its transform is not finite or flattens space",
    ),
    "camera whose motion is not finite": (
        h.scene(camera=PerspectiveCamera(name="Eye", motion=np.stack([np.eye(4), np.full((4, 4), np.nan)]))),
        "camera 'Eye': its motion is not finite or flattens space",
    ),
    "camera that flattens space on its way": (
        h.scene(camera=PerspectiveCamera(name="Eye", motion=np.stack([np.eye(4), h.affine(np.diag((1.0, 1, 0)))]))),
        "camera 'Eye': its motion is not finite or flattens space",
    ),
    "camera without a window": (h.scene(camera=PerspectiveCamera(name="Eye", window=(0, 0, 0, 0))), "camera 'Eye': window is"),
    "world below zero": (h.scene(world=-1.0), r"world 'World': radiance is \(-1.0, -1.0, -1.0\)"),
    "world of NaN": (h.scene(world=math.nan), "world 'World': radiance is"),
    "something else as environment": (h.replaced(h.scene(), world=World(name="Sky", environment=7)), "world 'Sky': int is not an Env"),
    "environment of negative strength": (under(strength=(1, -1, 1)), r"world 'Sky': strength of the environment is \(1.0, -1.0, 1.0\)"),
    "environment of infinite strength": (under(strength=(1, math.inf, 1)), "world 'Sky': strength of the environment is"),
    "environment that is stretched": (under(world_from_map=np.diag((1, 1, 2))), "world 'Sky': its environment is turned by"),
    "environment that is turned by NaN": (under(world_from_map=np.full((3, 3), np.nan)), "world 'Sky': its environment is turned by"),
    "emission below zero": (wears(emission=(-1, 0, 0)), r"material 'wood': emission is \(-1.0, 0.0, 0.0\)"),
    "emission of inf": (wears(emission=(math.inf, 0, 0)), "material 'wood': emission is"),
    "reflectance of NaN": (wears(lobes=(Lambert((math.nan, 0, 0)),)), "material 'wood': lambert reflectance is"),
    "reflectance below zero": (wears(lobes=(Phong((-0.1, 0, 0)),)), "material 'wood': phong reflectance is"),
    "a sum above one": (wears(lobes=(Lambert((0.7, 0, 0)), Phong((0.4, 0, 0)))), "material 'wood' reflects .*1.1.*, more than it receives"),
    "exponent out of range": (wears(lobes=(Phong(exponent=-2.0),)), "material 'wood': Phong exponent is -2.0"),
    "exponent of NaN": (wears(lobes=(Phong(exponent=math.nan),)), "material 'wood': Phong exponent is nan"),
    "something else as lobe": (wears(lobes=("shiny",)), "material 'wood': str is not a BSDF"),
    "absorption below zero": (wears(medium=Medium(absorption=(0, -1, 0))), r"material 'wood': absorption is \(0.0, -1.0, 0.0\)"),
    "absorption of NaN": (wears(medium=Medium(absorption=(math.nan, 0, 0))), "material 'wood': absorption is"),
    "a priority between": (wears(medium=Medium(priority=0.5)), "material 'wood': priority is 0.5, allowed: whole numbers"),
    "an Abbe number of many": (
        wears(lobes=(Dielectric(1.5, abbe=CheckerTexture(odd=(30.0,) * 3, even=(60.0,) * 3)),)),
        "material 'wood': dielectric abbe is a texture, allowed: a constant",
    ),
    "something else as medium": (wears(medium=(1, 2, 3)), "material 'wood': tuple is not a medium"),
    "something else as light": (h.scene(lights=["lamp"]), "str is not a light"),
    "cone out of range": (h.scene(lights=[SpotLight(name="Cone", angle=0.0)]), "light 'Cone': angle 0.0 rad"),
    "sun out of range": (h.scene(lights=[SunLight(name="Sol", angle=7.0)]), "light 'Sol': angle is 7.0 rad"),
    "panel out of range": (h.scene(lights=[AreaLight(name="Panel", size_x=-1.0)]), "light 'Panel': size -1.0 x 1.0 m"),
    "bulb out of range": (h.scene(lights=[PointLight(name="Lamp", radius=-1.0)]), "light 'Lamp': radius is -1.0 m"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_rendered_is_refused_by_name(name):
    scene, message = REFUSED[name]
    with pytest.raises(SceneError, match=message):
        validate(scene, SETTINGS)
    with pytest.raises(SceneError, match=message):
        render_image(scene, SETTINGS)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"integrator": "magic"}, "unknown integrator 'magic'; known: distributed, path, path_blind, path_naive, whitted"),
        ({"sampler": "dice"}, "unknown sampler 'dice'; known: blue_noise, grid, multijitter, random, sobol, stratified"),
        ({"pixel_filter": "fog"}, "unknown pixel filter 'fog'; known: blackman_harris, box, gaussian, mitchell, tent"),
        ({"passes": ("Combined", "Mis")}, "unknown pass 'Mis'; known: .*Combined, .*Depth, "),
    ],
    ids=lambda x: next(iter(x)) if isinstance(x, dict) else "",
)
def test_unknown_plug_ins_are_refused_with_the_known_ones(changes, message):
    with pytest.raises(SceneError, match=message):
        next(render(h.scene(), Settings(**changes)))


LEFT_OUT = {
    "object of NaN": (
        h.scene([h.thing(h.quad(name="chair"), matrix=h.affine(translation=(0, np.nan, 0)))]),
        "the transform is not finite, so it is left out: object 'chair'",
    ),
    "light of NaN": (
        h.scene(lights=[PointLight(name="Lamp", intensity=(math.nan, 1, 1))]),
        "one of its values is not finite, so it is left out: light 'Lamp'",
    ),
    "light of inf": (
        h.scene(lights=[AreaLight(name="Lamp", world_from_light=h.affine(translation=(math.inf, 0, 0)))]),
        "one of its values is not finite, so it is left out: light 'Lamp'",
    ),
    "light below zero": (
        h.scene(lights=[SunLight(name="Sol", irradiance=(-1.0, 0, 0))]),
        "it would take light away, so it is left out: light 'Sol'",
    ),
}


@pytest.mark.parametrize("name", LEFT_OUT)
def test_what_can_be_left_out_is_and_the_rest_renders(name):
    """One line for each, and the picture is that of the scene without it."""
    scene, message = LEFT_OUT[name]
    lit = [PointLight(position=(1, 1, 3))]
    floor = h.thing(h.quad((0, 0, -0.5), (5, 0, 0), (0, 5, 0), name="floor"))
    image = render_image(h.replaced(scene, objects=(*scene.objects, floor), lights=(*scene.lights, *lit)), SETTINGS)
    assert image.warnings == (message,)
    clean = render_image(h.scene([floor], lit), SETTINGS)
    assert h.same_bits(image.passes["Combined"], clean.passes["Combined"])
    assert image.passes["Combined"][..., 0].max() > 0


@pytest.mark.parametrize("values", [(math.nan,), (math.inf, -math.inf), (math.nan, -1.0, 3.0)], ids=str)
def test_bad_pixels_of_an_environment_are_counted_and_black(values):
    checked, warnings = validate(under(holed(*values)), SETTINGS)
    bad = sum(not 0 <= value < math.inf for value in values)
    assert warnings == (f"{bad} pixels of its picture are not finite or below 0 and count as black: world 'Sky'",)
    expected = holed(*(value if 0 <= value < math.inf else 0 for value in values))
    assert h.same_bits(checked.world.environment.pixels, expected)
    assert np.isfinite(render_image(under(holed(*values)), SETTINGS).passes["Combined"]).all()


def test_an_environment_of_bad_pixels_alone_is_no_light():
    image = render_image(under(np.full((3, 2, 2), np.nan)), SETTINGS)
    assert "4 pixels" in image.warnings[0]
    assert image.passes["Combined"][..., :3].max() == 0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"pixels": np.zeros((2, 4, 3))}, r"environment 'Sky': pixels has shape \(2, 4, 3\)"),
        ({"pixels": np.zeros((3, 0, 4))}, "environment 'Sky': its picture of 4 x 0 pixels is empty"),
        ({"world_from_map": np.eye(4)}, r"environment 'Sky': world_from_map has shape \(4, 4\)"),
        ({"interpolation": "cubic"}, "environment 'Sky': interpolation is 'cubic', allowed: linear, closest"),
    ],
    ids=lambda x: next(iter(x)) if isinstance(x, dict) else "",
)
def test_a_bad_environment_is_refused_by_name(changes, message):
    with pytest.raises(SceneError, match=message):
        EnvironmentMap(**{"name": "Sky", "pixels": GREY, **changes})


def with_corner(x, name="torn"):
    """A square with one corner at `x`, and a vertex of no triangle that is no number."""
    vertices = np.concatenate((h.quad().vertices, np.full((3, 1), np.nan)), axis=1)
    vertices[0, 2] = x
    return h.thing(h.Mesh(name=name, vertices=vertices, triangles=h.quad().triangles))


def test_objects_that_lose_triangles_are_told_once_and_when_it_is_known():
    """What is not finite is seen at a glance, what is too far away when the size of the scene is known."""
    whole, torn, far = (with_corner(x, name) for x, name in ((0.5, "whole"), (np.nan, "torn"), (1e30, "far")))
    scene = h.scene([whole, torn, far, h.replaced(torn, name="twin")])
    _, warnings = validate(scene, SETTINGS)
    assert [warning.datablock for warning in warnings] == [("object", "torn"), ("object", "twin")]
    assert all(warning.is_lost for warning in warnings)
    told = render_image(scene, SETTINGS).warnings
    assert [warning.owner for warning in told] == ["object 'torn'", "object 'twin'", "object 'far'"]
    assert {warning.what for warning in told} == {"triangles with a corner that is not finite or too far away are left out"}
    assert prepare(scene, SETTINGS)[1] == told


def test_a_warning_is_a_line_for_people():
    assert SceneWarning("it glows", "light", "Lamp") == "it glows: light 'Lamp'"
    assert SceneWarning("it rains") == "it rains" and not SceneWarning("it rains").owner


def test_a_scene_that_is_fine_is_not_touched():
    scene = h.scene([h.thing(h.quad())], [PointLight()])
    checked, warnings = validate(scene, SETTINGS)
    assert warnings == ()
    assert checked.objects == scene.objects
    assert checked.lights == scene.lights


@pytest.mark.parametrize(
    "scene",
    [
        h.scene(),
        h.scene(world=0.5),
        h.scene(lights=[PointLight(), SunLight()]),
        h.scene([h.thing(h.quad())]),
        h.scene([h.Object(name="bare", mesh=h.quad())], [PointLight(position=(0, 0, 3))]),
        h.scene([h.thing(h.Mesh(name="empty", vertices=np.zeros((3, 0)), triangles=np.zeros((3, 0))))], [PointLight()]),
        h.scene([h.thing(h.Mesh(name="points", vertices=np.zeros((3, 9)), triangles=np.zeros((3, 0))))], world=0.5),
        h.scene([h.thing(h.quad(), matrix=h.affine(np.zeros((3, 3))))], [PointLight()]),
        h.scene([h.thing(h.quad(), matrix=h.affine(1e-30 * np.eye(3)))], [PointLight()]),
        h.scene([h.thing(h.quad((3, -4, 2), (1, 0, 0), (0, 1, 0)))], [PointLight()]),
    ],
    ids=[
        "nothing",
        "world",
        "lights",
        "no light",
        "no material",
        "no triangle",
        "loose points",
        "zero scale",
        "1e-30",
        "camera in a surface",
    ],
)
def test_poor_scenes_render_without_a_word(scene):
    """J14, J16: what is there, else black."""
    image = h.pixels(scene, SETTINGS)
    assert np.isfinite(image).all()
    if any(scene.world.radiance):
        assert (image == np.float32(0.5)).all()
