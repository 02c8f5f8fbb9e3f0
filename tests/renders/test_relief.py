"""Bump maps bend normals as the slope of their height asks, normal maps as their colours say; nothing leaks, nothing is lost."""

import numpy as np
import pytest

from glanz.engine import (
    Bitmap,
    BumpMap,
    Coordinates,
    GradientTexture,
    ImageTexture,
    Lambert,
    Material,
    NoiseTexture,
    NormalMap,
    Phong,
    Requirements,
    SceneError,
)
from glanz.engine.maths.vectors import dot
from glanz.engine.plan import Plan
from glanz.engine.textures import bump_map, normal_map
from glanz.engine.wavefront import relief
from glanz.tests import helpers as h, textured as t
from glanz.tests.contracts.test_textures import Points

SMALL = h.settings(width=16, height=16, samples=4, max_depth=2)
FLAT = t.with_uvs(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)))
SLOPE = GradientTexture(coordinates=Coordinates(source="object", matrix=np.array([[0.3, 0, 0, 0.5], *np.eye(4)[1:]])))
"""Height 0.3 x + 0.5 in metres of the object."""


def constant(*colour):
    return ImageTexture(Bitmap(name="constant", pixels=np.float32(colour)[:, None, None]))


DIFFUSE = Lambert((0.8, 0.8, 0.8))


def material(*reliefs, lobes=(DIFFUSE,)):
    return Material(name="bent", lobes=lobes, relief=reliefs)


def normals(mesh, reliefs, matrix=None, settings=SMALL):
    """The Normal pass (3, H, W) seen from above."""
    scene = t.facing(mesh, material(*reliefs))
    if matrix is not None:
        scene = h.replaced(scene, objects=[h.replaced(scene.objects[0], world_from_object=matrix)])
    image = h.render_image(scene, h.replaced(settings, passes=("Combined", "Normal")))
    return np.moveaxis(image.passes["Normal"], 2, 0)


def unit(*v):
    return np.array(v)[:, None, None] / np.linalg.norm(v)


@pytest.mark.parametrize("distance", [0.5, 1.0, -2.0])
def test_a_bump_on_a_slope_is_the_normal_of_the_slope(distance):
    """The surface z = d h(x): normal (-d h', 0, 1)."""
    found = normals(FLAT, [BumpMap(SLOPE, distance)])
    assert np.abs(found - unit(-0.3 * distance, 0, 1)).max() <= 2e-3


def test_slopes_catch_a_bump_of_the_other_sign(monkeypatch):
    height = bump_map._height
    monkeypatch.setattr(bump_map, "_height", lambda bump, at: -height(bump, at))
    with pytest.raises(AssertionError):
        test_a_bump_on_a_slope_is_the_normal_of_the_slope(0.5)


def test_a_bump_is_in_metres_of_the_world():
    """An object three times as large has slopes a third as steep."""
    found = normals(FLAT, [BumpMap(SLOPE, 1.0)], np.diag((3.0, 3.0, 3.0, 1.0)))
    assert np.abs(found - unit(-0.1, 0, 1)).max() <= 2e-3


def test_noise_bends_as_its_slopes():
    """Against differences of the texture itself in float64 steps of 2^-7; to 1 % of all but few pixels."""
    noise = NoiseTexture(Coordinates(source="object"), detail=0.0)
    found = normals(FLAT, [BumpMap(noise, 0.5)], settings=h.replaced(SMALL, samples=1024, width=8, height=8, filter_width=0.01))
    x, y = np.meshgrid((np.arange(8) + 0.5) / 4 - 1, -((np.arange(8) + 0.5) / 4 - 1))
    p = np.stack((x.ravel(), y.ravel(), 0 * x.ravel())).astype(np.float32)
    step = np.float32(2.0**-7)
    slope = [
        (noise.eval(Points(p + step * axis))[0] - noise.eval(Points(p - step * axis))[0]) / (2 * step)
        for axis in np.eye(3, dtype=np.float32)[:2, :, None]
    ]
    expected = np.stack((-0.5 * slope[0], -0.5 * slope[1], np.ones_like(slope[0])))
    expected /= np.linalg.norm(expected, axis=0)
    # Passes show the first sample, somewhere in the pixel: directions agree on the whole.
    assert h.dots(found.reshape(3, -1), expected).mean() >= 0.99


def test_strength_mixes_with_the_surfaces_normal():
    full, half = unit(-0.3, 0, 1), normals(FLAT, [BumpMap(SLOPE, 1.0, 0.5)])
    mixed = 0.5 * full + 0.5 * unit(0, 0, 1)
    assert np.abs(half - mixed / np.linalg.norm(mixed, axis=0)).max() <= 2e-3


@pytest.mark.parametrize("flat", [NormalMap(constant(0.5, 0.5, 1.0)), BumpMap(constant(0.3, 0.3, 0.3)), BumpMap(SLOPE, 0.0)])
def test_what_is_flat_changes_no_bit(flat):
    ball = h.icosphere(2, smooth=True)
    ball = t.with_uvs(ball, ball.vertices[:2])
    pictures = [
        h.pixels(h.scene([h.thing(ball, material(*reliefs, lobes=(Lambert((0.5,) * 3), Phong((0.4,) * 3, 20.0))))], world=1.0), SMALL)
        for reliefs in ((), (flat,))
    ]
    assert h.same_bits(*pictures)


def test_a_normal_map_turns_towards_u_and_v():
    """Red towards larger u, green towards larger v, wherever these point; strength scales both."""
    tilted = NormalMap(constant(0.75, 0.6, 0.9))
    assert np.abs(normals(FLAT, [tilted]) - unit(0.5, 0.2, 0.8)).max() <= 1e-5
    turned = t.with_uvs(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), ((0, 0, 1, 1), (0, -1, -1, 0)))
    # u along y, v along -x.
    assert np.abs(normals(turned, [tilted]) - unit(-0.2, 0.5, 0.8)).max() <= 1e-5
    mirrored = t.with_uvs(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), ((1, 0, 0, 1), (0, 0, 1, 1)))
    assert np.abs(normals(mirrored, [tilted]) - unit(-0.5, 0.2, 0.8)).max() <= 1e-5
    doubled = NormalMap(constant(0.75, 0.6, 0.9), strength=2.0)
    assert np.abs(normals(FLAT, [doubled]) - unit(1.0, 0.4, 0.8)).max() <= 1e-5


def test_directions_catch_a_bitangent_of_the_other_hand(monkeypatch):
    monkeypatch.setattr(normal_map, "cross", lambda a, b: -np.cross(a, b, axis=0))
    with pytest.raises(AssertionError):
        test_a_normal_map_turns_towards_u_and_v()


def test_a_mesh_without_coordinates_keeps_its_normals():
    found = normals(h.quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), [NormalMap(constant(0.9, 0.6, 0.6))])
    assert np.abs(found - unit(0, 0, 1)).max() == 0


STEEP = BumpMap(NoiseTexture(Coordinates(source="object"), detail=4.0), 100.0)


@pytest.mark.parametrize("relief_value", [STEEP, NormalMap(constant(1, 0, 0))])
def test_extreme_reliefs_stay_finite(relief_value):
    """A furnace of albedo 1 with bumps a hundred metres high, and with a map of normals that lie in the surface."""
    mesh = h.icosphere(2, smooth=True)
    scene = h.scene([h.thing(t.with_uvs(mesh, mesh.vertices[:2]), material(relief_value, lobes=(Lambert((1.0, 1.0, 1.0)),)))], world=1.0)
    image = h.pixels(scene, SMALL)
    assert np.isfinite(image).all()
    assert image.mean() > 0.2


def test_bent_normals_are_unit_and_on_the_side_of_the_surface(monkeypatch):
    surfaces = []
    bend = relief.bend_normals

    def kept(plan, rays, surface):
        surfaces.append(bend(plan, rays, surface))
        return surfaces[-1]

    monkeypatch.setattr("glanz.engine.plan.bend_normals", kept)
    rough = BumpMap(NoiseTexture(Coordinates(source="object"), detail=4.0), 3.0)
    h.pixels(h.scene([h.thing(h.icosphere(2), material(rough))], world=1.0), SMALL)
    for s in surfaces:
        assert np.abs(np.linalg.norm(s.ns, axis=0) - 1).max() <= 1e-5
        assert (dot(s.ns, s.n) > 0).all()
        assert not h.same_bits(s.ns, s.n)


def test_leaving_out_and_batches_change_no_bit(monkeypatch):
    bumpy = material(BumpMap(NoiseTexture(Coordinates(source="object")), 0.2), NormalMap(t.PAINTED, 0.5))
    scene = h.scene([h.thing(FLAT, bumpy), h.thing(h.box((-0.2, -0.2, 0), (0.2, 0.2, 0.5)))], world=1.0)
    reference = h.pixels(scene, SMALL)
    assert h.same_bits(h.pixels_of_plan(Plan.of(scene, SMALL, Requirements.everything(scene, SMALL))), reference)
    assert h.same_bits(h.pixels(scene, h.replaced(SMALL, tile_size=3)), reference)
    monkeypatch.setattr("glanz.engine.rendering.LANES", 7)
    assert h.same_bits(h.pixels(scene, SMALL), reference)


def test_reliefs_ask_by_name_and_are_checked():
    found = Requirements.of(t.facing(FLAT, material(BumpMap(SLOPE))), SMALL).as_dict()
    assert found["relief"] == found["footprints"] == ["bent"]
    for wrong, word in ((NormalMap(SLOPE, space="screen"), "space"), (BumpMap((1.0, 2.0)), "input")):
        with pytest.raises(SceneError, match=word):
            h.pixels(t.facing(FLAT, material(wrong)), SMALL)
