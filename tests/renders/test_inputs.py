"""What textures are told of points, rays and paths, against what is known of a few plain scenes."""

import numpy as np
import pytest

from glanz.engine import (
    Attribute,
    BumpMap,
    CameraData,
    Coordinates,
    Dielectric,
    Fresnel,
    Geometry,
    Lambert,
    LambertTransmission,
    LayerWeight,
    LightPath,
    LinearTexture,
    Material,
    MeshAttribute,
    Mirror,
    NoiseTexture,
    NormalMap,
    Object,
    ObjectValue,
    OrthographicCamera,
    PerspectiveCamera,
    Requirements,
    SunLight,
    Tangent,
    Transparent,
    VectorTransform,
    Wireframe,
    World,
)
from glanz.engine.plan import Plan
from glanz.engine.wavefront import light_path
from glanz.tests import helpers as h, textured as t

SMALL = h.settings(width=16, height=16, samples=1, filter_width=0.01, sampler="grid")
MATRIX = h.affine(h.rotation(3), (0.4, -0.3, 0.2))
CENTRE = (np.arange(16) + 0.5) / 8 - 1
X, Y = np.meshgrid(CENTRE, -CENTRE)
"""Where pixels look, metres to the right and up, through `facing`."""


def signed(texture):
    """Half of it plus a half, which emission can show."""
    return LinearTexture((texture,), (0.5,), (0.5, 0.5, 0.5))


def glowing(texture, **others):
    return Material(name="glowing", emission=LinearTexture((texture,), (1.0,)), **others)


def seen(texture, camera=None, mesh=None, matrix=MATRIX):
    """Values (3, H, W) of a texture on a box that is turned, and what is seen of it: p, n (3, H, W) by intersection in float64."""
    mesh = mesh or h.box((-0.6, -0.7, -0.5), (0.6, 0.5, 0.4))
    material = Material(name="glowing", emission=signed(texture))
    camera = camera or OrthographicCamera(world_from_camera=h.affine(translation=(0, 0, 5)), window=(-1, 1, -1, 1))
    box = Object(name="box", mesh=mesh, materials=(material,), world_from_object=matrix)
    values = 2 * h.pixels(h.scene([box], camera=camera), SMALL) - 1
    inverse = np.linalg.inv(matrix)
    o = inverse[:3, :3] @ np.stack((X, Y, 0 * X + 5)).reshape(3, -1) + inverse[:3, 3:]
    d = inverse[:3, :3] @ np.array([[0], [0], [-1.0]])
    low, high = mesh.vertices.min(axis=1, keepdims=True), mesh.vertices.max(axis=1, keepdims=True)
    near = np.minimum((low - o) / d, (high - o) / d)
    far = np.maximum((low - o) / d, (high - o) / d).min(axis=0)
    axis, distance = near.argmax(axis=0), near.max(axis=0)
    n = np.where(np.arange(3)[:, None] == axis, -np.sign(d), 0)
    p = matrix[:3, :3] @ (o + distance * d) + matrix[:3, 3:]
    shape = (3, *X.shape)
    return values, p.reshape(shape), (matrix[:3, :3] @ n).reshape(shape), (distance < far).reshape(X.shape)


def shares(values, expected, is_seen, tolerance=1e-4):
    """How many of the pixels that see the box show what is expected; edges may fall to either side."""
    # What is below -1 is darker than black.
    return (np.abs(values - np.maximum(expected, -1)).max(axis=0) <= tolerance)[is_seen].mean()


OUTPUTS = {
    "position": (Coordinates(source="position"), lambda p, n: p),
    "camera": (Coordinates(source="camera"), lambda p, n: np.stack((p[0], p[1], 5 - p[2]))),
    "window": (CameraData("window"), lambda p, n: np.stack((0.5 * p[0] + 0.5, 0.5 * p[1] + 0.5, 0 * p[2]))),
    "depth": (CameraData("depth"), lambda p, n: 5 - p[2]),
    "distance": (CameraData("distance"), lambda p, n: np.linalg.norm((p[0], p[1], 5 - p[2]), axis=0)),
    "normal": (Geometry("normal"), lambda p, n: n),
    "object normal": (Geometry("object normal"), lambda p, n: np.einsum("ji,jhw->ihw", MATRIX[:3, :3], n)),
    "incoming": (Geometry("incoming"), lambda p, n: np.stack((0 * n[0], 0 * n[0], 1 + 0 * n[0]))),
    "reflection": (Geometry("reflection"), lambda p, n: np.stack((0 * n[0], 0 * n[0], -1 + 0 * n[0])) + 2 * n[2] * n),
    "facing": (LayerWeight(0.5), lambda p, n: 1 - n[2]),
    "length": (LightPath("length"), lambda p, n: 5 - p[2]),
}


@pytest.mark.parametrize("name", OUTPUTS)
def test_points_say_where_they_are_and_how_they_face(name):
    texture, expected = OUTPUTS[name]
    values, p, n, is_seen = seen(texture)
    assert is_seen.sum() > 60
    assert shares(values, expected(p, n), is_seen) >= 0.97


def test_points_catch_a_camera_that_looks_the_other_way(monkeypatch):
    monkeypatch.setattr("glanz.engine.world.views.CameraSpace.points", lambda self, p: -self.vectors(p))
    with pytest.raises(AssertionError):
        test_points_say_where_they_are_and_how_they_face("camera")


TO_OBJECT = np.linalg.inv(MATRIX)
SPACES = {
    ("point", "world", "object"): lambda p, n: np.einsum("ij,jhw->ihw", TO_OBJECT[:3, :3], p) + TO_OBJECT[:3, 3, None, None],
    ("point", "world", "camera"): lambda p, n: np.stack((p[0], p[1], 5 - p[2])),
    ("vector", "object", "world"): lambda p, n: np.einsum("ij,jhw->ihw", MATRIX[:3, :3], p),
    ("vector", "camera", "world"): lambda p, n: np.stack((p[0], p[1], -p[2])),
}


@pytest.mark.parametrize("kind", SPACES, ids=" ".join)
def test_vectors_are_carried_from_space_to_space(kind):
    values, p, n, is_seen = seen(VectorTransform(Coordinates(source="position"), *kind))
    assert shares(values, SPACES[kind](p, n), is_seen) >= 0.97


def test_normals_stay_at_right_angles_to_what_is_stretched():
    """The normal of the plane x + y + z = 0, after space is stretched by (1, 2, 4), is along (1, 1/2, 1/4)."""
    scene = t.facing(h.quad(), glowing(VectorTransform((1.0, 1.0, 1.0), "normal", "object", "world")))
    scene = h.replaced(scene, objects=[h.replaced(scene.objects[0], world_from_object=np.diag((1.0, 2.0, 4.0, 1.0)))])
    assert h.pixels(scene, SMALL)[:, 8, 8] == pytest.approx(np.array((4, 2, 1)) / np.sqrt(21), abs=1e-6)


def test_the_window_of_a_perspective_camera_is_its_picture():
    camera = PerspectiveCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0), fov=0.5)
    values = seen(CameraData("window"), camera=camera)[0]
    is_seen = values[2] == 0
    expected = np.stack((0.5 * X + 0.5, 0.5 * Y + 0.5, 0 * X))
    assert is_seen.sum() > 60
    assert shares(values, expected, is_seen) >= 0.97


def test_backs_are_seen_as_backs():
    for matrix, is_back in ((np.eye(4), 0), (np.diag((1.0, -1.0, -1.0, 1.0)), 1), (np.diag((-1.0, 1.0, 1.0, 1.0)), 0)):
        for texture, expected in ((Geometry("backfacing"), (is_back,) * 3), (Geometry("normal"), (0, 0, 1))):
            scene = room_scene(texture)
            scene = h.replaced(scene, objects=[h.replaced(scene.objects[0], world_from_object=matrix)])
            assert h.pixels(scene, SMALL)[:, 8, 8] == pytest.approx(expected, abs=1e-6)


def test_edges_are_as_wide_as_they_are_asked_to_be():
    """The share of a triangle within d of its edges is 1 - (1 - d / r)^2, with the radius r of its inscribed circle."""
    settings = h.replaced(SMALL, width=64, height=64, samples=16, pixel_filter="box", filter_width=1.0, sampler="stratified")
    mesh = h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0))
    found = h.pixels(t.facing(mesh, glowing(Wireframe(0.2))), settings).mean()
    radius = 2 - np.sqrt(2)
    assert found == pytest.approx(1 - (1 - 0.1 / radius) ** 2, abs=0.003)


def room(texture, *objects, floor=None, **others):
    """The value of a texture on a lid one metre above the floor, seen from below the lid; by whatever the floor does."""
    lid = h.thing(h.quad((0, 0, 1), (20, 0, 0), (0, 20, 0), "lid"), glowing(texture))
    ground = h.thing(h.quad((0, 0, 0), (20, 0, 0), (0, 20, 0), "floor"), floor or Material(name="floor"))
    camera = OrthographicCamera(world_from_camera=h.affine(translation=(0, 0, 0.8)), window=(-0.1, 0.1, -0.1, 0.1))
    settings = h.replaced(SMALL, width=4, height=4, samples=256, sampler="sobol", max_depth=8, **others)
    return h.pixels(h.scene([lid, ground, *objects], camera=camera), settings)


DIFFUSE, MIRROR = Material(name="diffuse", lobes=(Lambert((1.0,) * 3),)), Material(name="mirror", lobes=(Mirror((1.0,) * 3),))
THROUGH = {"camera": (0, 0), "diffuse": (1, 0), "glossy": (0, 1), "singular": (0, 1), "reflection": (1, 1), "transmission": (0, 0),
           "depth": (1, 1), "diffuse depth": (1, 0), "glossy depth": (0, 1), "transmission depth": (0, 0), "transparent depth": (0, 0),
           "shadow": (0, 0)}  # fmt: skip


@pytest.mark.parametrize("output", THROUGH)
def test_scattered_rays_know_by_what(output):
    """By a floor that reflects all light once, with rays that run into the lid alone: (diffuse, mirror)."""
    for floor, expected in zip((DIFFUSE, MIRROR), THROUGH[output]):
        settings = {"integrator": "path_blind"} if floor is DIFFUSE else {}
        assert room(LightPath(output), floor=floor, **settings) == pytest.approx(expected, abs=0.02)


def test_kinds_catch_lobes_that_are_taken_for_others(monkeypatch):
    monkeypatch.setattr(Lambert, "is_diffuse", False)
    with pytest.raises(AssertionError):
        test_scattered_rays_know_by_what("diffuse")


@pytest.mark.parametrize("integrator", ["path", "distributed"])
def test_mixtures_are_told_apart_in_proportion(integrator):
    """Half mirror, half diffuse: half of what is seen came by each."""
    floor = Material(name="both", lobes=(Lambert((0.5,) * 3), Mirror((0.5,) * 3)))
    singular = room(LightPath("singular"), floor=floor, integrator=integrator)
    assert singular.mean() == pytest.approx(0.5, abs=0.02)


def test_lights_that_only_the_camera_sees_light_nothing():
    """The lid is seen and the floor stays dark, sampled or met."""
    lid = LinearTexture((LightPath("camera"),), (5.0,))
    assert (room(lid, floor=DIFFUSE) == 0).all()
    quad = h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0))
    assert h.pixels(t.facing(quad, glowing(lid)), SMALL) == pytest.approx(5)


@pytest.mark.parametrize("faces_up", [True, False])
def test_shadow_rays_see_the_side_that_they_meet(faces_up):
    """A sheet is there for who sees its back: shadow rays from the floor meet it from below, the camera from above."""
    sheet = h.quad((0, 0, 1), (9, 0, 0), (0, 9, 0) if faces_up else (0, -9, 0))
    material = Material(name="sheet", lobes=(Lambert((1.0,) * 3),), alpha=Geometry("backfacing"))
    scene = t.facing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)), DIFFUSE, lights=[SunLight(irradiance=(1.0, 1.0, 1.0))])
    scene = h.replaced(scene, objects=(*scene.objects, h.thing(sheet, material)))
    found = h.pixels(scene, h.replaced(SMALL, max_depth=0)).mean()
    # The floor in the shadow of its back, or the back itself, lit.
    assert found == pytest.approx(0 if faces_up else 1 / np.pi, rel=1e-4, abs=1e-6)


def test_a_world_that_only_the_camera_sees_lights_nothing():
    world = World(radiance=LinearTexture((LightPath("camera"),), (3.0,)))
    floor = t.facing(h.quad(), DIFFUSE)
    floor = h.replaced(floor, world=world)
    image = h.pixels(floor, h.replaced(SMALL, samples=64))
    assert image[:, 0, 0] == pytest.approx(3)
    assert (image[:, 6:10, 6:10] == 0).all()


def test_veils_are_counted():
    """Behind k surfaces that all light passes the transparent depth is k."""
    veil = Material(name="veil", lobes=(Transparent((1.0, 1.0, 1.0)),))
    quad = h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0))
    veils = [h.thing(h.quad((0, 0, 0.1 + 0.1 * i), (2, 0, 0), (0, 2, 0)), veil) for i in range(3)]
    for k in range(4):
        scene = t.facing(quad, glowing(LightPath("transparent depth")))
        scene = h.replaced(scene, objects=(*scene.objects, *veils[:k]))
        assert h.pixels(scene, SMALL) == pytest.approx(k)


@pytest.mark.parametrize("lobe", [Dielectric(1.0), LambertTransmission((1.0, 1.0, 1.0))])
def test_what_passes_is_transmitted(lobe):
    sheet = h.thing(h.quad((0, 0, 0.5), (2, 0, 0), (0, 2, 0)), Material(name="sheet", lobes=(lobe,)))
    scene = t.facing(h.quad((0, 0, 0), (99, 0, 0), (0, 99, 0)), glowing(LightPath("transmission")))
    scene = h.replaced(scene, objects=(*scene.objects, sheet))
    assert h.pixels(scene, h.replaced(SMALL, samples=64, max_depth=3, integrator="path_blind")).mean() == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize("space", ["world", "object", "blender world", "blender object"])
def test_a_normal_map_in_a_space_is_the_direction_that_its_colour_says(space):
    n = np.array([0.2, -0.3, 0.7])
    turned = MATRIX[:3, :3] if "object" in space else np.eye(3)
    colour = turned.T @ n * ((1, -1, -1) if "blender" in space else (1, 1, 1))
    relief = NormalMap(tuple((0.5 + 0.5 * colour).tolist()), space=space)
    quad = Object(name="q", mesh=h.quad(), materials=(Material(name="m", relief=(relief,)),), world_from_object=MATRIX)
    camera = OrthographicCamera(world_from_camera=h.affine(translation=(0.4, -0.3, 5)), window=(-0.1, 0.1, -0.1, 0.1))
    image = h.render_image(h.scene([quad], camera=camera), h.replaced(SMALL, passes=("Combined", "Normal")))
    facing = np.sign(MATRIX[2, 2])
    assert np.abs(image.passes["Normal"] - facing * n / np.linalg.norm(n)).max() <= 1e-4 or facing < 0


BALL = t.with_uvs(h.icosphere(2, smooth=True), h.icosphere(2).vertices[:2])


def everything(emission=(0.0, 0.0, 0.0)):
    """A lit scene whose materials ask for all that there is to ask."""
    ball = h.replaced(BALL, attributes=(MeshAttribute(name="a", values=np.random.default_rng(1).random((4, BALL.vertices.shape[1]))),))
    noise = NoiseTexture(Coordinates(source="position"))
    bumped = BumpMap(noise, LinearTexture((Attribute("a", "number"),), (0.3,)), normal=Tangent("uv"))
    colours = [Attribute("a"), ObjectValue("x"), Geometry("object normal"), CameraData("window"), Tangent("x"), NormalMap(noise), bumped]
    numbers = [Fresnel(normal=bumped), LayerWeight(noise), Wireframe(0.1), Wireframe(2.0, True), *(LightPath(o) for o in THROUGH)]
    mixed = LinearTexture((*colours, *numbers), (0.1,) * len(colours) + (0.05,) * len(numbers))
    veil = Transparent(LinearTexture((LightPath("shadow"),), (0.3,)))
    material = Material(name="asking", lobes=(Lambert(mixed), Mirror((0.2,) * 3), veil))
    material = h.replaced(material, emission=emission, relief=(BumpMap(noise, 0.1),))
    one = Object(name="one", mesh=ball, materials=(material,), values=(("x", (1, 0.5, 0.2, 1)),))
    two = h.replaced(one, name="two", world_from_object=h.affine(0.5 * np.eye(3), (1.1, 0.2, 0.3)), values=())
    moving = h.replaced(one, name="three", motion=np.stack([h.affine(h.rotation(i), (-1.2, 0.1 * i, 0)) for i in (4, 5)]))
    return h.scene([one, two, moving], world=0.5)


def test_leaving_out_and_batches_change_no_bit_of_what_textures_ask(monkeypatch):
    """Glowing things are left out where nothing is pruned: which light is chosen depends on what lobes there may be."""
    settings = h.settings(width=12, height=12, samples=4, max_depth=3)
    dark, scene = everything(), everything(LinearTexture((LightPath("depth"),), (0.1,)))
    pruned, reference = h.pixels(dark, settings), h.pixels(scene, settings)
    assert np.isfinite(pruned).all() and np.isfinite(reference).all()
    assert h.same_bits(h.pixels_of_plan(Plan.of(dark, settings, Requirements.everything(dark, settings))), pruned)
    assert h.same_bits(h.pixels(scene, h.replaced(settings, tile_size=5, threads=2)), reference)
    monkeypatch.setattr("glanz.engine.rendering.LANES", 7)
    assert h.same_bits(h.pixels(scene, settings), reference)


def test_lamps_that_are_sampled_glow_as_those_that_are_met():
    """A dull floor under a smooth lamp that glows by its facing: by shadow rays the same as by scattered rays alone."""
    lamp = h.icosphere(2, 0.5, (0, 0, 1), smooth=True)
    glow = Material(name="glow", emission=LinearTexture((LayerWeight(0.7), Geometry("object normal")), (3.0, 0.5), (0.6, 0.6, 0.6)))
    objects = [h.thing(lamp, glow), h.thing(h.quad((0, 0, 0), (0.5, 0, 0), (0, 0.5, 0)), h.lambert(0.8))]
    camera = PerspectiveCamera.look_at((1.5, 0, 0.4), (0, 0, 0), fov=0.2)
    means = []
    for integrator in ("path", "path_blind"):
        found = h.pixels(h.scene(objects, camera=camera), h.settings(width=8, height=8, samples=400, max_depth=1, integrator=integrator))
        means.append(found.reshape(3, -1).mean(axis=1))
    np.testing.assert_allclose(*means, rtol=0.03)


def test_the_glow_of_lamps_catches_normals_that_are_not_theirs(monkeypatch):
    up = np.float32([[0], [0], [1]])
    monkeypatch.setattr("glanz.engine.world.views.smooth_normals", lambda triangles, prim, u, v, n, sign: 0 * n + up)
    with pytest.raises(AssertionError):
        test_lamps_that_are_sampled_glow_as_those_that_are_met()


def test_paths_carry_their_past_only_where_a_texture_asks():
    asked = Requirements.of(room_scene(LightPath("diffuse")), SMALL).as_dict()
    assert asked["light paths"] == ["glowing"]
    for output in ("camera", "length", "depth", "shadow"):
        plan = h.plan_of(room_scene(LightPath(output)), SMALL)
        assert not {name for name, _ in plan.carry} & {name for name, _ in light_path.CARRIED}


def room_scene(texture):
    return t.facing(h.quad(), glowing(texture))
