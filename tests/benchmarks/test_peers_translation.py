"""Mitsuba renders what Glanz renders, of scenes that are translated; what it does not have in the same form is refused by name."""

from dataclasses import replace

import numpy as np
import pytest

from glanz.engine import (
    Bitmap,
    Coordinates,
    Dielectric,
    EnvironmentMap,
    ImageTexture,
    Lambert,
    Lens,
    Material,
    Mesh,
    Mirror,
    Object,
    PerspectiveCamera,
    Phong,
    PointLight,
    Scene,
    Settings,
    World,
    render_image,
)
from glanz.tests import helpers as h

mi = pytest.importorskip("mitsuba", reason="Mitsuba is not installed: make bench-peers installs it")
mi.set_variant("scalar_rgb")
translate = pytest.importorskip("glanz.benchmarks.peers.translate")

SETTINGS = Settings(width=12, height=8, samples=64, max_depth=3, pixel_filter="box", sampler="sobol", filter_textures=False, threads=1)
CAMERA = PerspectiveCamera.look_at((0.4, -3.0, 1.2), (0.1, 0.0, 0.5), fov=0.7, aspect=1.5)
PICTURE = np.random.default_rng(1).uniform(0, 1, (3, 4, 8)).astype(np.float32)


def by_mitsuba(scene, settings=SETTINGS):
    """(H, W, 3) linear pixels."""
    side = max(settings.width, settings.height)
    made = mi.load_dict(translate.translate(scene, settings, (side,)))
    index = translate.sensor_index((side,), side, "multijitter")
    return np.array(mi.render(made, sensor=index, spp=settings.samples, seed=1))


def by_glanz(scene, settings=SETTINGS):
    return render_image(scene, settings).passes["Combined"][..., :3]


def difference(scene, settings=SETTINGS):
    """RMSE of the pixels, and the difference of the means, over the mean."""
    a, b = by_glanz(scene, settings), by_mitsuba(scene, settings)
    assert a.shape == b.shape
    return rmse_over_mean(a, b), abs(b.mean() / a.mean() - 1)


def rmse_over_mean(a, b):
    return np.sqrt(((a - b) ** 2).mean()) / a.mean()


def thing(mesh, *lobes, emission=(0.0, 0.0, 0.0), matrix=None):
    material = Material(name=f"{mesh.name} material", lobes=lobes, emission=emission)
    return Object(name=mesh.name, mesh=mesh, materials=(material,), world_from_object=np.eye(4) if matrix is None else matrix)


def floor(*lobes):
    return thing(h.quad(x=(4, 0, 0), y=(0, 4, 0), name="floor"), *(lobes or (Lambert((0.7, 0.5, 0.3)),)))


def lamp():
    """Over the origin, facing down."""
    return thing(h.quad(centre=(0, 0, 2), x=(0, 1.5, 0), y=(1.5, 0, 0), name="lamp"), emission=(3.0, 2.5, 2.0))


def test_the_camera_sees_things_where_they_are():
    """A glowing triangle that has no symmetry: no mirror image, no half turn, no shift by a quarter of a pixel."""
    mesh = Mesh(name="glow", vertices=np.array([[-0.5, 0.9, 0.1], [0, 0.2, 0.1], [0.1, 0.3, 1.2]]), triangles=np.array([[0], [1], [2]]))
    scene = Scene(camera=CAMERA, objects=(thing(mesh, emission=(1.0, 2.0, 3.0)),))
    rmse, mean = difference(scene, replace(SETTINGS, samples=1024))
    assert rmse <= 0.02
    assert mean <= 0.004
    moved = replace(scene, camera=PerspectiveCamera.look_at((0.43, -3.0, 1.2), (0.13, 0.0, 0.5), fov=0.7, aspect=1.5))
    assert np.sqrt(((by_glanz(moved) - by_mitsuba(scene)) ** 2).mean()) > 0.1 * by_glanz(scene).mean()


def test_an_environment_is_seen_in_the_same_directions():
    """To the texel, up to the poles: what is seen is interpolated between 8 x 4 random colours."""
    pixels = np.random.default_rng(2).uniform(0, 1, (3, 4, 8)).astype(np.float32)
    turn, _ = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    environment = EnvironmentMap(pixels=pixels, world_from_map=turn, strength=(1.0, 2.0, 0.5))
    for target in ((1, 0, 0), (-1, 0.3, 0.2), (0.01, 0, 1), (0, -1, -0.5)):
        camera = PerspectiveCamera.look_at((0, 0, 0), target, fov=1.4, aspect=1.5)
        rmse, mean = difference(Scene(camera=camera, world=World(environment=environment)))
        assert rmse <= 0.01
        assert mean <= 0.002


@pytest.mark.parametrize("extension", ["repeat", "extend", "mirror"])
@pytest.mark.parametrize("is_smooth", [True, False])
def test_a_picture_lies_on_a_surface_as_it_does_in_glanz(extension, is_smooth):
    mesh = h.quad(x=(2, 0, 0), y=(0, 2, 0), name="floor")
    uvs = np.array([[[-0.7, 1.6, 1.6, -0.7], [-0.4, -0.4, 1.5, 1.5]]])
    mesh = replace(mesh, uv_layers=("UV",), uvs=uvs, uv_indices=mesh.triangles)
    texture = ImageTexture(Bitmap(name="picture", pixels=PICTURE), extension=extension, is_smooth=is_smooth)
    world = World(radiance=(1.0, 1.0, 1.0))
    scene = Scene(camera=CAMERA, objects=(thing(mesh, Lambert(texture)),), world=world)
    rmse, mean = difference(scene, replace(SETTINGS, samples=256))
    assert rmse <= 0.03
    assert mean <= 0.005


@pytest.mark.parametrize(
    "lobes",
    [
        (Lambert((0.8, 0.4, 0.2)),),
        (Mirror((0.9, 0.6, 0.3)),),
        (Lambert((0.5, 0.1, 0.05)), Mirror((0.2, 0.2, 0.2))),
        (Lambert((0.05, 0.05, 0.7)), Mirror((0.25, 0.2, 0.05))),
        (Dielectric(1.5),),
        (Dielectric(1.3, (1.0, 0.8, 0.6), (0.9, 0.95, 0.7)),),
        (),
    ],
    ids=["diffuse", "mirror", "mixed", "mixed to the full", "glass", "tinted glass", "black"],
)
def test_materials_look_the_same(lobes):
    """A flat box and a smooth ball, turned, stretched and mirrored, under a lamp and a sky; noise is 2 to 6 % of a pixel."""
    stretched = np.array([[0.0, -0.5, 0, -0.5], [0.4, 0, 0, 0.2], [0, 0, 0.6, 0.1], [0, 0, 0, 1]])
    ball = h.icosphere(2, radius=0.4, smooth=True, name="ball")
    turned = np.diag((-1.0, 1.0, 1.2, 1.0)) @ np.eye(4)
    turned[:3, 3] = (0.5, 0.0, 0.55)
    things = (floor(), lamp(), thing(h.box(), *lobes, matrix=stretched), thing(ball, *lobes, matrix=turned))
    scene = Scene(camera=CAMERA, objects=things, world=World(radiance=(0.3, 0.4, 0.5)))
    rmse, mean = difference(scene, replace(SETTINGS, samples=196))
    assert rmse <= 0.08
    assert mean <= 0.01


def test_points_and_the_faces_of_several_materials_shine_and_look_the_same():
    mesh = replace(h.quad(x=(3, 0, 0), y=(0, 3, 0), name="two"), material_indices=np.array([0, 1]))
    materials = (Material(name="red", lobes=(Lambert((0.8, 0.1, 0.1)),)), Material(name="blue", lobes=(Lambert((0.1, 0.1, 0.8)),)))
    bulb = PointLight(position=(0.5, -0.5, 1.0), intensity=(2.0, 1.0, 0.5))
    lights = (bulb, PointLight(position=(-1, 0.5, 0.6), intensity=(0.1, 0.9, 0.3)))
    scene = Scene(camera=CAMERA, objects=(Object(name="two", mesh=mesh, materials=materials),), lights=lights)
    rmse, mean = difference(scene, replace(SETTINGS, samples=256))
    assert rmse <= 0.08
    assert mean <= 0.01


def test_a_lens_blurs_as_much():
    glows = [thing(h.box((x, y, 0), (x + 0.4, y + 0.1, 0.8)), emission=(1.0, 1.0, 1.0)) for x, y in ((-0.7, -1.2), (0, 0), (0.7, 2))]
    scene = Scene(camera=replace(CAMERA, lens=Lens(radius=0.3, focus_distance=3.0)), objects=glows)
    theirs = by_mitsuba(scene, replace(SETTINGS, samples=1024))
    assert rmse_over_mean(by_glanz(scene, replace(SETTINGS, samples=1024)), theirs) <= 0.05
    for lens in (Lens(radius=0.2, focus_distance=3.0), Lens(radius=0.3, focus_distance=2.5)):
        assert rmse_over_mean(by_glanz(replace(scene, camera=replace(CAMERA, lens=lens))), theirs) > 0.1


def test_depth_counts_the_same_bounces():
    """In a closed white furnace each bounce adds as much as half of the one before."""
    glow = Material(name="glow", lobes=(Lambert((0.5, 0.5, 0.5)),), emission=(1.0, 1.0, 1.0))
    mesh = h.box((-2, -4, -1), (2, 2, 2), name="furnace")
    inwards = replace(mesh, triangles=mesh.triangles[::-1])
    scene = Scene(camera=CAMERA, objects=(Object(name="furnace", mesh=inwards, materials=(glow,)),))
    for depth in (0, 1, 4):
        settings = replace(SETTINGS, max_depth=depth, samples=16)
        expected = 2 - 0.5 ** (depth + 1)
        assert abs(by_glanz(scene, settings).mean() - expected) <= 0.01 * expected
        assert abs(by_mitsuba(scene, settings).mean() - expected) <= 0.01 * expected


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"objects": (floor(Phong((0.5, 0.5, 0.5), 20.0)),)}, "material 'floor material' has the lobes Phong"),
        ({"objects": (floor(Dielectric(1.5, abbe=30.0)),)}, "material 'floor material' is glass"),
        ({"objects": (floor(Lambert(ImageTexture(Bitmap(name="b", pixels=np.zeros((3, 2, 2), np.uint8))))),)}, "encoded by sRGB"),
        ({"objects": (floor(Lambert(ImageTexture(coordinates=Coordinates(source="object")))),)}, "no plain picture"),
        ({"objects": (replace(floor(), hidden_from=("camera",)),)}, "object 'floor' moves or is hidden"),
        ({"lights": (PointLight(name="bulb", radius=0.1),)}, "light 'bulb'"),
        ({"camera": replace(CAMERA, window=(-0.5, 0.6, -0.5, 0.5))}, "shifted"),
        ({"camera": replace(CAMERA, lens=Lens(radius=0.1, blades=6))}, "no disk"),
    ],
)
def test_what_is_not_alike_is_refused_by_name(change, named):
    with pytest.raises(translate.Untranslatable, match=named):
        translate.translate(replace(Scene(camera=CAMERA), **change), SETTINGS, (8,))


def test_only_the_box_is_a_filter_of_both():
    with pytest.raises(translate.Untranslatable, match="blackman_harris"):
        translate.translate(Scene(camera=CAMERA), replace(SETTINGS, pixel_filter="blackman_harris"), (8,))
