"""What every pass promises (`interfaces.Pass`), checked for every class in the registry, and what each one holds."""

import math

import numpy as np
import pytest

from glanz.engine import (
    Coordinates,
    Lambert,
    LinearTexture,
    Material,
    Mist,
    PerspectiveCamera,
    SceneError,
    Transparent,
    World,
    render_image,
)
from glanz.engine.interfaces import Pass
from glanz.engine.maths.warps import square_to_uniform_hemisphere
from glanz.engine.passes import ambient_occlusion
from glanz.engine.passes.depth import Depth
from glanz.engine.registry import PASSES
from glanz.tests import helpers as h, scenes

OF_FAMILIES = ("CryptoObject00", "CryptoMaterial01", "CryptoAsset00", "Combined_key", "AOV Color a b", "AOV Value c")
"""At least one of each."""
ALL = (*PASSES, *OF_FAMILIES)
each = pytest.mark.parametrize("plugin", [PASSES[key] for key in ALL], ids=lambda p: p.key)


def passes_of(scene, **changes):
    return render_image(scene, h.settings(passes=ALL, replicates=2, **changes)).passes


@each
def test_a_pass_offers_the_interface(plugin):
    assert isinstance(plugin, Pass)
    assert PASSES[plugin.key] == plugin
    assert plugin.channels in ("RGBA", "RGB", "X", "Z", "XYZ", "UVA", "XYZW", "rgba")
    assert plugin.reduction in ("mean", "first", "sum", "ranks", "replicates")
    assert plugin.records in ("", "first hit", "light", "first hit and light")
    assert not plugin.records or isinstance(plugin.background, float)
    assert not plugin.divided_by or plugin.divided_by in PASSES
    assert plugin.__doc__.strip()


@each
def test_a_pass_renders_alone_as_beside_all_others(plugin):
    """Bit for bit, with its channels, in float32, finite."""
    alone = render_image(scenes.everything(), h.settings(passes=(plugin.key,), replicates=2)).passes
    assert list(alone) == [plugin.key]
    values = alone[plugin.key]
    assert values.shape == (8, 8, len(plugin.channels))
    assert values.dtype == np.float32
    assert np.isfinite(values).all()
    assert h.same_bits(values, passes_of(scenes.everything())[plugin.key])


@each
def test_a_pass_of_an_empty_scene_is_its_background(plugin):
    values = passes_of(h.scene(world=0.25))[plugin.key]
    if plugin.reduction == "sum":
        assert (values == 4).all()
    elif plugin.reduction == "replicates":
        assert (values == 0).all()
    elif plugin.key in ("Environment", "Denoising Albedo"):
        assert (values == 0.25).all()
    elif plugin.records:
        assert (values == np.float32(plugin.background)).all()
    else:
        assert (values == np.array((0.25, 0.25, 0.25, 1.0), np.float32)).all()


def plane_at(angle, distance=2.0):
    """A camera that looks straight along -z at a large plane, tilted by `angle` about x, `distance` away."""
    camera = PerspectiveCamera.look_at((0.1, 0.2, distance), (0.1, 0.2, 0), up=(0, 1, 0), fov=math.radians(40))
    turn = np.array([[1, 0, 0], [0, math.cos(angle), -math.sin(angle)], [0, math.sin(angle), math.cos(angle)]])
    plane = h.thing(h.quad((0, 0, 0), (25 * distance, 0, 0), (0, 25 * distance, 0)), h.lambert(0.5), h.affine(turn, (0.1, 0.2, 0)))
    return h.scene([plane], camera=camera), turn[:, 2]


def test_depth_is_measured_along_the_axis_of_the_camera():
    """Not along the ray: a plane across the view is equally deep everywhere; to 1e-6."""
    scene, _ = plane_at(0.0, 7.5)
    np.testing.assert_allclose(passes_of(scene)["Depth"], 7.5, rtol=1e-6)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_depth_is_in_metres_at_every_scale(scale):
    scene, _ = plane_at(0.0, 3.0 * scale)
    np.testing.assert_allclose(passes_of(scene)["Depth"][4, 4], 3.0 * scale, rtol=1e-6)


def test_depth_of_a_tilted_plane_is_that_of_one_sample():
    """No mean over depths: each value is the depth of a point within its pixel."""
    scene, normal = plane_at(0.5)
    depth = passes_of(scene, samples=16)["Depth"][..., 0].astype(np.float64)
    top = math.tan(math.radians(20))
    edges = top - np.arange(9) / 8 * 2 * top  # of the rows, on the image plane at distance 1
    exact = 2.0 * normal[2] / (normal[2] - edges * normal[1])
    assert (depth <= np.maximum(exact[:-1], exact[1:])[:, None] + 1e-5).all()
    assert (depth >= np.minimum(exact[:-1], exact[1:])[:, None] - 1e-5).all()


def test_depth_is_measured_from_where_the_camera_is_at_the_time_of_the_sample():
    """A camera that moves back, seen by a wall: the depth of the first sample is one on the way, and differs from pixel to pixel."""
    scene, _ = plane_at(0.0, 7.5)
    view = scene.camera.world_from_camera
    back = view @ h.affine(translation=(0, 0, 1.0))
    camera = h.replaced(scene.camera, motion=np.stack([view, back]))
    for clipped in ({}, {"clip_start": 0.5, "clip_end": 30.0}):
        depth = passes_of(h.replaced(scene, camera=h.replaced(camera, **clipped)), samples=1)["Depth"]
        assert 7.4999 < depth.min() < 7.7
        assert 8.3 < depth.max() < 8.5
        assert np.unique(depth).size > 50


def test_depth_catches_a_distance_along_the_ray(monkeypatch):
    def along_the_ray(plan, rays, surface, reflection):
        return np.sqrt((surface.p**2).sum(axis=0))[None] / np.float32(plan.world.frame.scale)

    monkeypatch.setattr(Depth, "values", staticmethod(along_the_ray))
    scene, _ = plane_at(0.0, 7.5)
    with pytest.raises(AssertionError):
        np.testing.assert_allclose(passes_of(scene)["Depth"], 7.5, rtol=1e-6)


@pytest.mark.parametrize("angle", [0.0, 0.5, 2.5])
def test_normals_are_those_of_the_world_on_the_side_of_the_viewer(angle):
    scene, normal = plane_at(angle)
    towards = normal * np.sign(normal[2])
    np.testing.assert_allclose(passes_of(scene)["Normal"], np.broadcast_to(towards, (8, 8, 3)), atol=1e-6)


def test_normals_of_a_smooth_sphere_are_its_directions():
    camera = PerspectiveCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0), fov=math.radians(5))
    normals = passes_of(h.scene([h.thing(h.icosphere(4, smooth=True))], camera=camera), samples=16)["Normal"]
    middle = normals[3:5, 3:5].reshape(-1, 3).mean(axis=0)
    np.testing.assert_allclose(middle, (0, 0, 1), atol=2e-3)
    assert normals[0, :, 1].min() > 0.1 > -0.1 > normals[-1, :, 1].max()  # up is y
    assert normals[:, -1, 0].min() > 0.1 > -0.1 > normals[:, 0, 0].max()  # right is x


def test_normals_at_an_edge_are_averaged():
    """A pixel half on a plane and half on nothing has half a normal: what an edge-preserving filter wants."""
    camera = PerspectiveCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0))
    half = h.thing(h.quad((-5, 0, 0), (10, 0, 0), (0, 10, 0)), h.lambert(0.5))
    normal = passes_of(h.scene([half], camera=camera), width=1, height=1, samples=64)["Normal"][0, 0]
    assert normal[2] == pytest.approx(0.5, abs=0.02)


def test_the_picture_is_opaque():
    assert (passes_of(scenes.everything())["Combined"][..., 3] == 1).all()


def test_positions_are_in_the_world_where_the_pixel_looks():
    """On the plane, and less than a pixel from where the ray through its middle meets it; far from the origin, too."""
    for offset in (np.zeros(3), np.array((1000.0, -2000.0, 500.0))):
        camera = PerspectiveCamera.look_at(offset + np.array((0, 0, 4)), offset, up=(0, 1, 0), fov=math.radians(40))
        scene = h.scene([h.thing(h.quad(offset, (50, 0, 0), (0, 50, 0)))], camera=camera)
        p = passes_of(scene)["Position"] - offset
        assert np.abs(p[..., 2]).max() <= 1e-3
        pixel = 2 * 4 * math.tan(math.radians(20)) / 8
        middle = (np.arange(8) - 3.5) * pixel
        assert np.abs(p[..., 0] - middle).max() <= pixel / 2 + 1e-3
        assert np.abs(p[..., 1] + middle[:, None]).max() <= pixel / 2 + 1e-3


@pytest.mark.parametrize(("falloff", "share"), [("linear", 0.25), ("quadratic", 0.0625), ("inverse_quadratic", 0.5)])
def test_mist_grows_with_the_distance_in_a_straight_line(falloff, share):
    """A quarter of the way through: 1/4, its square, its root, to 1e-5; nothing before it begins, all of it behind."""
    camera = PerspectiveCamera.look_at((0, 0, 3), (0, 0, 0), up=(0, 1, 0), fov=math.radians(1e-3))
    scene = h.scene([h.thing(h.quad((0, 0, 0), (50, 0, 0), (0, 50, 0)))], camera=camera)
    for start, depth, expected in ((2.0, 4.0, share), (4.0, 4.0, 0.0), (0.5, 1.0, 1.0), (2.0, 0.0, 0.0)):
        misty = h.replaced(scene, world=h.replaced(scene.world, mist=Mist(start=start, depth=depth, falloff=falloff)))
        np.testing.assert_allclose(passes_of(misty)["Mist"], expected, rtol=1e-5)


def test_data_of_surfaces_are_what_the_scene_says():
    """Coordinates that vary linearly over a quad, the numbers of its object and material, its colour, its normal for the camera."""
    mesh = h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0))
    uv = np.array([[[0, 1, 1, 0], [0, 0, 1, 1]]], np.float32)
    mesh = h.replaced(mesh, uv_layers=("uv",), uvs=uv, uv_indices=mesh.triangles)
    o = h.thing(mesh, h.replaced(h.lambert((0.2, 0.4, 0.6)), index=7.0))
    camera = PerspectiveCamera.look_at((0, 0, 1), (0, 0, 0), up=(0, 1, 0), fov=math.radians(45))
    found = passes_of(h.scene([h.replaced(o, values=(("index", (5, 5, 5, 1)),))], camera=camera), samples=64)
    top = math.tan(math.radians(22.5))
    across = 0.5 + 0.5 * top * (np.arange(8) - 3.5) / 4
    np.testing.assert_allclose(found["UV"][..., 0], np.broadcast_to(across, (8, 8)), atol=2e-3)
    np.testing.assert_allclose(found["UV"][..., 1], np.broadcast_to(across[::-1, None], (8, 8)), atol=2e-3)
    assert (found["UV"][..., 2] == 1).all()
    assert (found["Object Index"] == 5).all()
    assert (found["Material Index"] == 7).all()
    np.testing.assert_allclose(found["Denoising Albedo"], np.broadcast_to((0.2, 0.4, 0.6), (8, 8, 3)), rtol=1e-6)
    np.testing.assert_allclose(found["Denoising Normal"], np.broadcast_to((0, 0, -1), (8, 8, 3)), atol=1e-6)
    assert 1 <= found["Denoising Depth"].min() <= found["Denoising Depth"].max() < 1.25
    without = passes_of(h.scene([h.thing(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)))], camera=camera))
    assert not any(without[key].any() for key in ("UV", "Object Index", "Material Index"))


def test_aovs_are_what_materials_say_where_they_are_met():
    """A texture, a constant, and nothing: by the share of a pixel that they fill."""
    position = LinearTexture((Coordinates(source="position"),), (1.0,))
    sayer = h.replaced(h.lambert(), aovs=(("place", position), ("heat", 0.75)))
    halves = [h.quad((x, 0, 0), (10, 0, 0), (0, 10, 0), name=str(x)) for x in (-5, 5)]
    camera = PerspectiveCamera.look_at((0, 0, 1), (0, 0, 0), up=(0, 1, 0), fov=math.radians(45))
    scene = h.scene([h.thing(halves[0], sayer), h.thing(halves[1])], camera=camera)
    keys = ("AOV Color place", "AOV Value heat", "AOV Color heat", "AOV Value none")
    place, heat, grey, none = render_image(scene, h.settings(passes=keys, samples=64, width=2, height=2)).passes.values()
    middle = 0.5 * math.tan(math.radians(22.5))
    np.testing.assert_allclose(place[:, 0, 0], -middle, atol=0.01)
    np.testing.assert_allclose(place[:, 0, 1], (middle, -middle), atol=0.01)
    assert (place[:, 0, 3] == 1).all()
    assert (heat[:, 0] == 0.75).all()
    np.testing.assert_allclose(grey[:, 0], np.broadcast_to((0.75, 0.75, 0.75, 1), (2, 4)))
    assert not (place[:, 1].any() or heat[:, 1].any() or none.any())


@pytest.mark.parametrize("value", [(1, 2), "warm", None], ids=str)
def test_aovs_that_are_none_are_refused(value):
    wrong = h.scene([h.thing(h.quad(), h.replaced(h.lambert(), aovs=(("heat", value),)))])
    with pytest.raises(SceneError, match="material 'diffuse': its AOV"):
        render_image(wrong, h.settings())


@pytest.mark.parametrize(("distance", "open_share"), [(0.5, 1.0), (2.0, 0.25), (4.0, 0.0625)])
@pytest.mark.parametrize("alpha", [1.0, 0.4])
def test_ambient_occlusion_is_that_of_a_ceiling(distance, open_share, alpha):
    """At a height h all is hidden that is nearer than R: cos > h / R, which is 1 - (h / R)^2 of a cosine's lobe.

    What of it is there counts. By 16,384 samples, to 6 standard deviations of chance on either side.
    """
    floor, ceiling = (h.quad((0, 0, z), (200, 0, 0), (0, 200, 0), name=str(z)) for z in (0, 1))
    camera = PerspectiveCamera.look_at((0, 0, 0.5), (0, 0, 0), up=(0, 1, 0), fov=math.radians(20))
    scene = h.scene([h.thing(floor, h.replaced(h.lambert(), alpha=alpha)), h.thing(ceiling)], camera=camera)
    scene = h.replaced(scene, world=h.replaced(scene.world, occlusion_distance=distance))
    found = render_image(scene, h.settings(passes=("Ambient Occlusion",), samples=256)).passes["Ambient Occlusion"]
    assert found.mean() == pytest.approx(alpha * open_share, abs=6 * 0.5 / 128)


@pytest.mark.parametrize("integrator", ["path", "whitted"])
def test_ambient_occlusion_is_shared_by_what_covers_a_pixel(integrator):
    """A veil, of which 0.4 is clear, under the open sky, before a floor under a ceiling that hides all."""
    floor, ceiling = (h.quad((0, 0, z), (200, 0, 0), (0, 200, 0), name=str(z)) for z in (0, 0.01))
    veil = Material(name="veil", lobes=(Lambert((0.5,) * 3), Transparent((0.4,) * 3)))
    camera = PerspectiveCamera.look_at((0, 0, 2), (0, 0, 0), up=(0, 1, 0), fov=0.2)
    ceiling = h.replaced(h.thing(ceiling), hidden_from=("camera", "glossy", "transmission"))
    scene = h.scene([h.thing(floor), ceiling, h.thing(h.quad((0, 0, 1), (9, 0, 0), (0, 9, 0), name="veil"), veil)], camera=camera)
    found = render_image(scene, h.settings(passes=("Ambient Occlusion",), samples=256, integrator=integrator))
    assert found.passes["Ambient Occlusion"].mean() == pytest.approx(0.6, abs=6 * 0.5 / 128)


def test_ambient_occlusion_catches_directions_that_are_not_cosines(monkeypatch):
    monkeypatch.setattr(ambient_occlusion, "square_to_cosine_hemisphere", square_to_uniform_hemisphere)
    with pytest.raises(AssertionError):
        test_ambient_occlusion_is_that_of_a_ceiling(2.0, 0.25, 1.0)


def test_vectors_are_pixels_from_frame_to_frame():
    """A plane that came from the left and will go up, seen by a camera that will move right; far from the origin, too."""
    for offset in (np.zeros(3), np.array((1e5, -2e5, 5e4))):
        camera = PerspectiveCamera.look_at(offset + np.array((0, 0, 4)), offset, up=(0, 1, 0), fov=2 * math.atan(0.5))
        at, view = h.affine(translation=offset), camera.world_from_camera
        plane = h.thing(h.quad((0, 0, 0), (50, 0, 0), (0, 50, 0)), matrix=at)
        plane = h.replaced(plane, beside=(h.affine(translation=(-0.25, 0, 0)) @ at, h.affine(translation=(0, 0.5, 0)) @ at))
        scene = h.scene([plane], camera=camera, camera_beside=(view, h.affine(translation=(1, 0, 0)) @ view))
        # Four metres wide at the plane, eight pixels.
        found = passes_of(scene)["Vector"]
        np.testing.assert_allclose(found, np.broadcast_to((-0.5, 0, 2, -1), (8, 8, 4)), atol=1e-5)
    still = np.zeros((0, 4, 4))
    assert not passes_of(h.replaced(scene, objects=[h.replaced(plane, beside=still)], camera_beside=still))["Vector"].any()


def test_matrices_beside_are_two():
    with pytest.raises(SceneError, match="object 'quad': beside are 3 matrices"):
        h.replaced(h.thing(h.quad()), beside=np.zeros((3, 4, 4)))


@pytest.mark.parametrize("integrator", ["path", "path_blind"])
def test_what_is_not_there_occludes_nothing(integrator):
    """A ceiling of alpha 0, also for integrators that send no shadow rays of their own."""
    floor = h.thing(h.quad((0, 0, 0), (40, 0, 0), (0, 40, 0)), h.lambert(0.5))
    ceiling = h.thing(h.quad((0, 0, 3), (40, 0, 0), (0, 40, 0)), Material(name="clear", lobes=(Lambert(),), alpha=0.0))
    camera = PerspectiveCamera.look_at((0, 0, 2), (0, 0, 0), up=(0, 1, 0), fov=0.2)
    scene = h.scene([floor, ceiling], camera=camera)
    assert (passes_of(h.replaced(scene, world=World(occlusion_distance=100.0)), integrator=integrator)["Ambient Occlusion"] == 1).all()
