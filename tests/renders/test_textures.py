"""Textured pictures with known answers: what is seen, what is lit, what does not alias, what does not depend on batches."""

import numpy as np
import pytest

from glanz.engine import (
    CheckerTexture,
    Coordinates,
    GradientTexture,
    ImageTexture,
    Lambert,
    LinearTexture,
    Material,
    Mirror,
    Object,
    PerspectiveCamera,
    Phong,
    Requirements,
    SceneError,
    Transparent,
    rendering,
)
from glanz.engine.maths.mipmaps import decoding_table
from glanz.engine.plan import Plan
from glanz.engine.wavefront import cones
from glanz.engine.world import attributes
from glanz.engine.world.texturing import TexturedGlow
from glanz.tests import chance, helpers as h, textured as t
from glanz.tests.moving import moving, turned

SMALL = h.settings(width=24, height=16, samples=4, max_depth=3, threads=2)
RAMP = GradientTexture(coordinates=Coordinates(matrix=np.eye(4)))
"""Grey that is u."""


def diffuse(texture, **others):
    return Material(name="textured", lobes=(Lambert(texture),), **others)


def pixel_centres(n):
    """u, v (n, n) of the pixels of `textured.facing`, row 0 on top."""
    u = (np.arange(n) + 0.5) / n
    return np.broadcast_to(u, (n, n)), np.broadcast_to(u[::-1, None], (n, n))


SQUARE = t.with_uvs(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)))


@pytest.mark.parametrize("shines", [True, False], ids=["emission", "reflectance"])
def test_a_picture_is_seen_as_it_is(shines):
    """Texel by texel, upright and not mirrored; a diffuse surface under an even sky of 1 shows its reflectance (furnace)."""
    texture = ImageTexture(t.PICTURE, extension="extend", is_smooth=False)
    material = Material(name="m", emission=texture) if shines else diffuse(texture)
    settings = h.settings(width=16, height=8, samples=64, max_depth=1)
    image = h.pixels(t.facing(SQUARE, material, world=1.0), settings)
    texels = decoding_table(True).take(t.PICTURE.pixels)[:, ::-1]
    np.testing.assert_allclose(image, texels, rtol=0, atol=2e-6 if shines else 2e-5)


@pytest.mark.parametrize("u_to", [1.0, -2.5])
def test_texture_coordinates_are_interpolated_linearly(u_to):
    """A ramp over the square, whatever its coordinates run to; to the width of a pixel's jitter."""
    mesh = t.with_uvs(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), ((0, u_to, u_to, 0), (0, 0, 1, 1)))
    ramp = GradientTexture(coordinates=Coordinates(matrix=np.diag((1 / u_to, 1, 1, 1))))
    image = h.pixels(t.facing(mesh, Material(name="m", emission=ramp)), h.settings(width=16, height=16, samples=16))
    assert np.abs(image - pixel_centres(16)[0]).max() <= 0.5 / 16


@pytest.mark.parametrize("source", ["object", "generated"])
def test_coordinates_of_an_object_move_with_it(source):
    """The picture of a box is the same wherever it stands, however it is turned, if the camera goes along."""
    mesh = h.box((-0.5, -0.25, -1), (0.5, 0.75, 1))
    texture = CheckerTexture(coordinates=Coordinates(source=source, matrix=np.diag((3.0, 4.0, 5.0, 1.0))))
    camera = PerspectiveCamera.look_at((3, -4, 2), (0, 0, 0))
    move = h.affine(h.rotation(3), (0.3, -0.7, 1.1))
    pictures = []
    for matrix in (np.eye(4), move):
        seen = h.replaced(camera, world_from_camera=matrix @ camera.world_from_camera)
        scene = h.scene([h.thing(mesh, Material(name="m", emission=texture), matrix)], camera=seen)
        pictures.append(h.pixels(scene, h.settings(width=32, height=32, samples=16)))
    assert (np.abs(pictures[0] - pictures[1]) <= 0.02).mean() > 0.98
    assert pictures[0].std() > 0.1


def test_generated_coordinates_span_the_bounding_box():
    mesh = h.box((-3, 2, 5), (1, 2.5, 105))
    found = attributes.generated(mesh)
    assert found.min(axis=1).tolist() == [0, 0, 0]
    assert found.max(axis=1).tolist() == [1, 1, 1]
    assert attributes.generated(h.quad())[2].tolist() == [0.5] * 4
    given = h.replaced(mesh, generated=np.full(mesh.vertices.shape, 0.25))
    assert attributes.generated(given) is given.generated


def test_mirrored_instances_keep_their_texture():
    """The winding of mirrored triangles is turned; their coordinates must be turned with it."""
    ramp = Material(name="m", emission=RAMP)
    settings = h.settings(width=16, height=16, samples=16)
    plain = h.pixels(t.facing(SQUARE, ramp), settings)
    both = [h.thing(SQUARE, ramp, np.diag((-1.0, 1, 1, 1))), h.thing(SQUARE, ramp, h.affine(translation=(9, 0, 0)))]
    mirrored = h.scene(both, camera=t.facing(SQUARE, ramp).camera)
    assert np.abs(h.pixels(mirrored, settings)[:, :, ::-1] - plain).max() <= 1 / 16


def test_mirroring_catches_corners_that_are_not_turned(monkeypatch):
    corners = attributes._corners
    monkeypatch.setattr(attributes, "_corners", lambda part, *rest: corners(h.replaced(part, mirrored=np.zeros_like(part.mirrored)), *rest))
    with pytest.raises(AssertionError):
        test_mirrored_instances_keep_their_texture()


def test_layers_are_told_apart_by_name_and_one_that_lacks_is_0():
    layers = np.array([t.CORNERS, (t.CORNERS[1], t.CORNERS[0])])
    mesh = t.with_uvs(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), layers, names=("first", "second"))
    u, v = pixel_centres(8)
    for layer, expected in (("", u), ("first", u), ("second", v), ("none", 0 * u)):
        ramp = GradientTexture(coordinates=Coordinates(layer=layer))
        image = h.pixels(t.facing(mesh, Material(name="m", emission=ramp)), h.settings(samples=16))
        assert np.abs(image - expected).max() <= 0.5 / 8, layer


def test_materials_take_turns_on_one_mesh():
    """Each triangle shows its own material's texture, and what has none is untouched."""
    mesh = h.replaced(SQUARE, material_indices=[0, 1])
    one, two = Material(name="ramp", emission=RAMP), Material(name="plain", emission=(0.25, 0.25, 0.25))
    scene = t.facing(mesh, one)
    scene = h.replaced(scene, objects=[Object(name="o", mesh=mesh, materials=(one, two))])
    image = h.pixels(scene, h.settings(width=16, height=16, samples=16))
    u, v = pixel_centres(16)
    assert np.abs(image - u)[:, u > v + 0.1].max() <= 0.5 / 16
    assert (image[:, u < v - 0.1] == 0.25).all()


@chance.fresh
def test_light_from_a_textured_emitter_is_found_both_ways():
    """Shadow rays that know the texture, and rays that run into it: one mean; detects 3 %."""
    lamp = h.thing(
        t.with_uvs(h.quad((0, 0, 1.5), (0, 2, 0), (2, 0, 0))),
        Material(name="lamp", emission=LinearTexture((ImageTexture(t.PICTURE, is_smooth=False),), ((5.0, 3.0, 1.0),))),
    )
    floor = h.thing(h.quad((0, 0, 0), (3, 0, 0), (0, 3, 0)), h.lambert(0.5))
    dark = Material(name="dark lamp", emission=LinearTexture((RAMP,), ((2.0, 2.0, 2.0),)))
    other = h.thing(t.with_uvs(h.quad((0, 1.4, 1), (1, 0, 0), (0, 0, 1), name="other")), dark)
    scene = h.scene([floor, lamp, other], camera=PerspectiveCamera.look_at((3, -4, 3), (0, 0, 0), fov=0.3))
    means = {}
    for integrator in ("path", "path_blind"):
        settings = [h.settings(integrator=integrator, samples=256, max_depth=0, seed=seed) for seed in range(12)]
        means[integrator] = np.array([h.pixels(scene, s).mean(axis=(1, 2)) for s in settings])
    for channel in range(3):
        assert h.means_agree(means["path"][:, channel], means["path_blind"][:, channel])
    assert means["path"].mean() > 0.01
    assert means["path"].std(axis=0).max() < 0.02 * means["path"].mean()


def test_both_ways_catch_an_emitter_lit_by_its_average(monkeypatch):
    def average(self, E, k, p, wi, distance):
        return E * np.float32([[2.5], [1.5], [0.5]])

    monkeypatch.setattr(TexturedGlow, "lit", average)
    with pytest.raises(AssertionError):
        test_light_from_a_textured_emitter_is_found_both_ways()


def plain_to_the_horizon(texture, **others):
    floor = h.thing(h.quad((0, 0, 0), (4000, 0, 0), (0, 4000, 0), name="floor"), Material(name="m", emission=texture))
    return h.scene([floor, *others.get("more", ())], camera=PerspectiveCamera.look_at((0.3, -1990.2, 1), (0, -1900.4, -1), fov=0.8))


BLACK_AND_WHITE = {"odd": (1.0, 1.0, 1.0), "even": (0.0, 0.0, 0.0)}
CHECKER = CheckerTexture(**BLACK_AND_WHITE, coordinates=Coordinates(source="object"))
TILES = ImageTexture(
    t.Bitmap(name="tiles", pixels=np.kron([[0, 1], [1, 0]], np.ones((8, 8))).astype(np.uint8)[None].repeat(3, 0) * np.uint8(255)),
    Coordinates(source="object", matrix=np.diag((0.5, 0.5, 1.0, 1.0))),
)


def near_the_horizon(scene, samples=1, **changes):
    """The rows below the horizon in which a pixel covers six tiles or more along the view."""
    image = h.pixels(scene, h.settings(width=128, height=128, samples=samples, max_depth=0, **changes))[0]
    horizon = np.nonzero(image.any(axis=1))[0][0]
    return image[horizon + 1 : horizon + 5]


@pytest.mark.parametrize("texture", [CHECKER, TILES], ids=["checker", "image"])
def test_a_checkerboard_to_the_horizon_is_grey_at_one_sample(texture):
    """Every pixel near the horizon is the mean of black and white, to 0.1; without filtering all are 0 or 1."""
    rows = near_the_horizon(plain_to_the_horizon(texture))
    assert np.abs(rows - 0.5).max() <= 0.1
    assert abs(rows.mean() - 0.5) <= 0.01


def test_the_horizon_catches_textures_without_footprints(monkeypatch):
    monkeypatch.setattr("glanz.engine.plan.footprints_of_cones", cones.no_footprints)
    rows = near_the_horizon(plain_to_the_horizon(CHECKER))
    assert np.abs(rows - 0.5).min() > 0.4


@pytest.mark.parametrize("texture", [CHECKER, TILES], ids=["checker", "image"])
def test_textures_that_are_not_to_be_filtered_are_looked_up_at_points(texture):
    """Pixels are black or white, but on borders of texels; nothing is carried for it, and to ask for everything changes nothing."""
    scene, settings = plain_to_the_horizon(texture), h.settings(filter_textures=False)
    rows = near_the_horizon(scene, filter_textures=False)
    assert (np.abs(rows - 0.5) == 0.5).mean() > 0.7
    assert "footprints" not in Requirements.of(scene, settings)
    assert h.plan_of(scene, settings).carry == ()
    everything = h.pixels_of_plan(Plan.of(scene, settings, Requirements.everything(scene, settings)))
    assert h.same_bits(everything, h.pixels(scene, settings))


def test_a_checkerboard_before_the_camera_stays_sharp():
    """At one sample the pixels that see one tile alone are black or white."""
    image = h.pixels(plain_to_the_horizon(CHECKER), h.settings(width=128, height=128, samples=1))[0]
    assert np.isin(image[-20:], (0, 1)).mean() > 0.9


def test_footprints_shrink_as_samples_grow():
    """What filtering adds to the pixel's own blur vanishes: 64 filtered samples give what 64 unfiltered ones do, to 2 %."""
    scene = h.replaced(plain_to_the_horizon(CHECKER), camera=PerspectiveCamera.look_at((0.3, -1990.2, 4), (0, -1975, 0), fov=0.8))
    settings = h.settings(width=48, height=48, samples=64, max_depth=0)
    required = Requirements.of(scene, settings)
    without = Requirements({need: names for need, names in required.needs.items() if need != "footprints"})
    a, b = (h.pixels_of_plan(Plan.of(scene, settings, r)) for r in (required, without))
    assert np.abs(a - b).mean() <= 0.02
    at_one = h.replaced(settings, samples=1)
    c, d = (h.pixels_of_plan(Plan.of(scene, at_one, r)) for r in (required, without))
    assert np.abs(c - d).mean() > np.abs(a - b).mean()


def test_cones_go_on_through_mirrors():
    """The horizon in a mirror that stands upright is as grey as it is behind it."""
    mirror = h.thing(h.quad((0, -1985, 0), (40, 0, 0), (0, 0, 40), name="mirror"), Material(name="mirror", lobes=(Mirror(),)))
    floor = h.thing(h.quad((0, 0, 0), (8000, 0, 0), (0, 8000, 0), name="floor"), Material(name="m", emission=CHECKER))
    camera = PerspectiveCamera.look_at((0.3, -1990.2, 1), (0, -1900.4, -1), fov=0.8)
    image = h.pixels(h.scene([floor, mirror], camera=camera), h.settings(width=128, height=128, samples=1, max_depth=2))[0]
    horizon = np.nonzero(image.any(axis=1))[0][0]
    assert np.abs(image[horizon + 1 : horizon + 5] - 0.5).max() <= 0.1


@pytest.mark.parametrize("integrator", ["path", "distributed"])
def test_cones_go_on_through_transparent_surfaces(integrator):
    """Behind clear panes the plain looks as it does without them, with as wide footprints."""
    clear = Material(name="clear", lobes=(Transparent((1, 1, 1)),))
    panes = [h.thing(h.quad((0, y, 0), (90, 0, 0), (0, 0, 40), name=f"pane at {y}"), clear) for y in (-1980, -1977)]
    settings = h.settings(width=32, height=32, samples=1, max_depth=1, integrator=integrator)
    through, plain = (h.pixels(plain_to_the_horizon(CHECKER, more=more), settings) for more in (panes, ()))
    assert (np.abs(through - plain).max(axis=0) <= 1e-3).mean() > 0.97


@pytest.fixture(scope="module")
def reference():
    return h.pixels(t.everything(), SMALL)


@pytest.mark.parametrize("tile_size", [0, 5, 1])
def test_threads_and_tiles_change_no_bit(reference, tile_size):
    assert h.same_bits(h.pixels(t.everything(), h.replaced(SMALL, tile_size=tile_size, threads=3)), reference)


@pytest.mark.parametrize("lanes", [7, 384])
def test_batches_change_no_bit(reference, monkeypatch, lanes):
    monkeypatch.setattr(rendering, "LANES", lanes)
    assert h.same_bits(h.pixels(t.everything(), SMALL), reference)


@pytest.mark.parametrize("k", [-20, 20])
def test_a_power_of_two_as_scale_changes_no_bit(reference, k):
    """Footprints scale with the scene; coordinates here do not depend on it."""
    assert h.same_bits(h.pixels(t.everything(scale=2.0**k), SMALL), reference)


def test_leaving_out_changes_no_bit(reference):
    scene = t.everything()
    assert h.same_bits(h.pixels_of_plan(Plan.of(scene, SMALL, Requirements.everything(scene, SMALL))), reference)
    assert reference.max() > 0


def test_textures_that_are_constant_change_no_bit():
    """A texture of one colour is that colour, in one lobe of two, too."""
    grey = LinearTexture(offset=(0.25, 0.5, 0.125))
    scene = h.scene([h.thing(h.box(), h.lambert(0.5, "m")), h.thing(h.quad((0, 0, -1), (4, 0, 0), (0, 4, 0)), h.lambert(0.7))], world=1.0)

    def picture(colour):
        box = h.replaced(scene.objects[0], materials=(Material(name="m", lobes=(Lambert(colour), Phong((0.5, 0.25, 0.5), 9.0))),))
        return h.pixels(h.replaced(scene, objects=[box, scene.objects[1]]), SMALL)

    assert h.same_bits(picture(grey), picture(grey.offset))


@pytest.mark.parametrize("shines", [True, False])
def test_what_is_below_0_counts_as_0(shines):
    negative = LinearTexture((RAMP,), ((1.0, -1.0, 1.0),), (0.0, 0.0, -0.5))
    material = Material(name="m", emission=negative) if shines else diffuse(negative)
    image = h.pixels(t.facing(SQUARE, material, world=1.0), h.settings(width=16, height=16, samples=16, max_depth=1))
    u = pixel_centres(16)[0]
    assert (image[1] == 0).all()
    assert np.abs(image[2] - np.maximum(u - 0.5, 0)).max() <= 1 / 16


def test_a_number_takes_the_luminance_of_a_texture():
    """A Phong exponent from a texture of one grey is that exponent."""

    def picture(exponent):
        ball = h.thing(h.icosphere(2, smooth=True), Material(name="m", lobes=(Phong((0.8, 0.8, 0.8), exponent),)))
        return h.pixels(h.scene([ball], world=1.0), SMALL)

    np.testing.assert_allclose(picture(LinearTexture(offset=(20.0, 20.0, 20.0))), picture(20.0), rtol=1e-4)


def test_a_scene_asks_for_textures_and_footprints_by_name():
    found = Requirements.of(t.facing(SQUARE, diffuse(t.CHECKERED)), SMALL).as_dict()
    assert found["textures"] == found["footprints"] == ["textured"]
    smooth = Requirements.of(t.facing(SQUARE, diffuse(RAMP)), SMALL)
    assert "textures" in smooth
    assert "footprints" not in smooth


def test_without_textures_nothing_is_carried_or_looked_up():
    plan = h.plan_of(h.scene([h.thing(SQUARE)]), SMALL)
    assert plan.carry == plan.adjust_reflection == ()
    assert plan.world.attributes == {}
    assert not plan.world.materials.textured


def test_coordinates_are_kept_for_the_triangles_that_ask():
    plain = h.thing(t.with_uvs(h.quad((0, 0, 1))), h.lambert(0.5))
    world = h.plan_of(h.scene([h.thing(SQUARE, diffuse(t.PAINTED)), plain]), SMALL).world
    assert list(world.attributes) == [("uv", "")]
    assert world.attributes["uv", ""].corners.shape == (9, 1 + 2)


def test_coordinates_that_are_not_finite_count_as_0_and_are_told():
    mesh = t.with_uvs(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), ((0, np.nan, 1, 0), (0, 0, np.inf, 1)))
    image = rendering.render_image(t.facing(mesh, diffuse(t.PAINTED), world=1.0), h.settings())
    assert image.warnings == ("uv coordinates that are not finite count as 0: object 'quad'",)
    assert np.isfinite(image.passes["Combined"]).all()


@pytest.mark.parametrize(
    ("material", "word"),
    [
        (Material(name="m", lobes=(Lambert(LinearTexture((h.replaced(RAMP, shape="odd"),), ((1.0,) * 3,))),)), "odd"),
        (diffuse(h.replaced(RAMP, coordinates=Coordinates(source="nowhere"))), "nowhere"),
        (Material(name="m", ambient=RAMP), "ambient"),
        (diffuse(LinearTexture((RAMP,), ((1.0, 2.0),))), "factor"),
        (diffuse(CheckerTexture(odd=(1.0, 2.0))), "input"),
    ],
)
def test_textures_are_checked_where_they_stand(material, word):
    with pytest.raises(SceneError, match=word):
        h.pixels(t.facing(SQUARE, material), h.settings())


@pytest.mark.parametrize("shines", [True, False])
def test_textures_move_with_their_objects(shines):
    """Box and camera turn together while the shutter is open: the picture is that of both at rest, footprints and all."""
    checker = CheckerTexture((0.9, 0.8, 0.1), (0.1, 0.2, 0.6), Coordinates(source="generated", matrix=np.diag((5.0, 4.0, 3.0, 1.0))))
    box = h.thing(h.box((-1, -1, -1), (1, 1, 1)), Material(name="m", emission=checker) if shines else diffuse(checker))
    camera = PerspectiveCamera.look_at((3, -4, 2), (0, 0, 0))
    # Between keys things move on straight lines, so a turn of both takes many.
    keys = turned(np.linspace(0.0, 0.7, 65))
    settings = h.settings(width=32, height=32, samples=16, max_depth=1)
    at_rest = h.pixels(h.scene([box], camera=camera, world=1.0), settings)
    follows = h.replaced(camera, motion=keys @ camera.world_from_camera)
    together = h.pixels(h.scene([moving(box, keys)], camera=follows, world=1.0), settings)
    assert (np.abs(together - at_rest).max(axis=0) <= 0.01).mean() > 0.97
    assert at_rest.std() > 0.1


def test_togetherness_catches_footprints_of_triangles_at_rest(monkeypatch):
    """The mutant sees edges as they are in the object's own frame: their footprints are wrong by the turn."""
    monkeypatch.setattr("glanz.engine.plan.edges_at_time", cones.edges_at_rest)
    with pytest.raises(AssertionError):
        test_textures_move_with_their_objects(True)


def test_light_from_a_moving_textured_emitter_is_found_both_ways():
    """As for one at rest; detects 5 %."""
    glow = LinearTexture((ImageTexture(t.PICTURE, is_smooth=False),), ((5.0, 3.0, 1.0),))
    lamp = h.thing(t.with_uvs(h.quad((0, 0, 1.5), (0, 2, 0), (2, 0, 0))), Material(name="lamp", emission=glow))
    floor = h.thing(h.quad((0, 0, 0), (3, 0, 0), (0, 3, 0)), h.lambert(0.5))
    plain = h.thing(h.quad((0, 1.4, 1), (1, 0, 0), (0, 0, 1), name="plain lamp"), h.lambert(0, "plain", 0.5))
    scene = h.scene([floor, plain, moving(lamp, turned((0.0, 1.0)))], camera=PerspectiveCamera.look_at((3, -4, 3), (0, 0, 0), fov=0.3))
    means = [
        [h.pixels(scene, h.settings(integrator=name, samples=256, max_depth=0, seed=s)).mean(axis=(1, 2)) for s in range(12)]
        for name in ("path", "path_blind")
    ]
    shadow, blind = np.array(means)
    for channel in range(3):
        assert h.means_agree(shadow[:, channel], blind[:, channel])
    assert shadow.std(axis=0).max() < 0.03 * shadow.mean()
