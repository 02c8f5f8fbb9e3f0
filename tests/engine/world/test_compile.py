"""Scene values become one mesh, one table of materials and one of lights (catalogue A14)."""

import numpy as np
import pytest

from glanz.engine import Lambert, Material, MemoryShortage, Phong, SceneError, memory
from glanz.engine.world import compile
from glanz.tests import helpers as h


def world_of(*objects, **others):
    return h.plan_of(h.scene(objects, **others), h.settings()).world


def render_space(world, p):
    return world.frame.points(np.asarray(p, float))


@pytest.mark.parametrize(
    "linear",
    [
        np.eye(3),
        np.diag((-1.0, 1, 1)),
        h.rotation(1) @ np.diag((1e-3, 1, 1e3)),
        h.rotation(2) @ np.diag((1.0, -2, 3)),
        [[1, 2, 0], [0, 1, 3], [0, 0, 1]],
    ],
    ids=["still", "mirrored", "stretched", "mirrored and stretched", "sheared"],
)
def test_outside_stays_outside(linear):
    """A14: geometric and shading normals of a closed mesh point out of it under any transform, mirrored or stretched.

    Where stretching turns a facet and the normal at its corner more than 90 degrees apart, the facet decides the side.
    """
    mesh = h.icosphere(2, smooth=True)
    matrix = h.affine(np.array(linear, float), (5, 6, 7))
    plan = h.plan_of(h.scene([h.thing(mesh, matrix=matrix)]), h.settings())
    shape = plan.world.triangles.shape.astype(np.float64).reshape(4, 3, -1)
    centre = render_space(plan.world, matrix[:3, 3:])
    middle = shape[0] + (shape[1] + shape[2]) / 3 - centre
    assert (h.dots(shape[3], middle) > 0).all()
    # The normal of the ellipsoid at M x is M^-T x; the corners of its facets carry that.
    corners = plan.world.triangles.corner_normals.astype(np.float64).reshape(3, 3, -1)[0]
    truth = np.linalg.inv(matrix[:3, :3]).T @ mesh.normals[:, mesh.triangles[0]].astype(np.float64)
    truth /= np.linalg.norm(truth, axis=0)
    facing = np.sign(h.dots(truth, shape[3]))
    assert h.dots(corners, truth * facing).min() >= 1 - 1e-5
    assert (facing > 0).mean() > 0.9
    assert (facing > 0).all() or np.linalg.cond(linear) > 4


@pytest.mark.parametrize("scales", [(1e-6, 1, 1e6), (1e6, 1e-6, -1), (1e-6, 1e-6, 1), (-1e6, 1, 1)], ids=str)
def test_outside_stays_outside_of_what_is_a_million_times_longer_than_wide(scales):
    """A14 at its end: normals point out, across the facets, and are unit to the rounding of float32.

    Around the camera; what is thinner than 2^-24 of its distance from it has facets of no area.
    """
    camera = h.PerspectiveCamera.look_at((5, 6, 7), (6, 7, 8))
    world = world_of(h.thing(h.icosphere(2), matrix=h.affine(np.diag(scales), (5, 6, 7))), camera=camera)
    v0, e1, e2, n = world.triangles.shape.astype(np.float64).reshape(4, 3, -1)
    assert n.shape[1] == 320
    assert (h.dots(n, v0 + (e1 + e2) / 3 - render_space(world, [[5], [6], [7]])) > 0).all()
    across = np.cross(e1, e2, axis=0)
    np.testing.assert_allclose(h.dots(n, across), np.linalg.norm(across, axis=0), rtol=1e-6)


def test_geometry_is_rounded_once():
    """World vertices in float64, rebased and scaled, then rounded: each within half a unit of float32."""
    mesh = h.Mesh(name="star", vertices=np.random.default_rng(1).standard_normal((3, 30)), triangles=np.arange(30).reshape(-1, 3).T)
    matrix = h.affine(h.rotation(4) * 1.7, (1e6, -2e6, 3e6))
    camera = h.PerspectiveCamera.look_at((1e6 + 5, -2e6, 3e6), (1e6, -2e6, 3e6))
    world = world_of(h.thing(mesh, matrix=matrix), camera=camera)
    truth = render_space(world, matrix[:3, :3] @ mesh.vertices + matrix[:3, 3:])[:, mesh.triangles[0]]
    first = world.triangles.shape[:3]
    assert (np.abs(first - truth) <= 2.0**-24 * np.abs(truth) * 1.0001).all()


def test_triangles_without_an_area_or_a_number_are_left_out_and_the_latter_told():
    vertices = np.array([[0, 1, 0, np.nan, 1e30], [0, 0, 1, 0, 0], [0, 0, 0, 0, 0]], float)
    triangles = np.array([[0, 1, 2], [0, 1, 1], [0, 0, 0], [0, 1, 3], [0, 1, 4]]).T
    world = world_of(h.thing(h.Mesh(name="odd", vertices=vertices, triangles=triangles)))
    assert world.triangles.material.size == 1
    assert world.warnings == ("triangles with a corner that is not finite or too far away are left out: object 'odd'",)


def test_each_triangle_wears_its_material():
    red, green, blue = (Material(name=n, lobes=(Lambert(c),)) for n, c in (("r", (0.9, 0, 0)), ("g", (0, 0.9, 0)), ("b", (0, 0, 0.9))))
    mesh = h.Mesh(name="fan", vertices=h.box().vertices, triangles=h.box().triangles, material_indices=np.arange(12) % 4)
    world = world_of(h.Object(name="o", mesh=mesh, materials=(red, green, blue)), h.thing(h.quad((9, 9, 9)), green))
    reflectance = world.materials.lobes[0].k.reflectance[:, world.triangles.material]
    # Indices beyond the last material take the last.
    expected = [((0, 1, 2, 2)[i % 4]) for i in range(12)] + [1, 1]
    assert reflectance.argmax(axis=0).tolist() == expected


def test_objects_without_a_material_are_black():
    world = world_of(h.Object(name="bare", mesh=h.quad()), h.thing(h.quad((0, 0, 1)), h.lambert(0.5)))
    reflectance = world.materials.lobes[0].k.reflectance[:, world.triangles.material]
    assert reflectance[0].tolist() == [0, 0, 0.5, 0.5]


def test_emissive_triangles_come_last_and_keep_their_radiance():
    world = world_of(
        h.thing(h.box(), h.lambert(0.5, "lamp", (3, 2, 1))), h.thing(h.icosphere(0, centre=(0, 0, 3)), h.lambert(0.5, "floor"))
    )
    assert world.triangles.first_emitter == 20
    assert (world.triangles.material[20:] == world.triangles.material[-1]).all()
    k = world.emitters.k
    assert (k.radiance == np.array([[3], [2], [1]])).all()
    assert k.area.sum() / world.frame.scale**2 == pytest.approx(6, rel=1e-6)


def test_instances_share_their_mesh_and_keep_their_places():
    mesh = h.quad()
    places = [(0, 0, 0), (3, 0, 0), (0, 3, 1)]
    world = world_of(*(h.thing(mesh, matrix=h.affine(translation=p)) for p in places))
    shape = world.triangles.shape.reshape(4, 3, -1)
    middle = (shape[0] + (shape[1] + shape[2]) / 3).reshape(3, 3, 2).mean(axis=2)
    np.testing.assert_allclose(middle, render_space(world, np.array(places).T), atol=1e-6)


def test_a_flat_transform_gives_no_surface_and_no_crash():
    world = world_of(
        h.thing(h.box(), matrix=h.affine(np.zeros((3, 3)), (1, 1, 1))),
        h.thing(h.icosphere(1, smooth=True), matrix=h.affine(np.diag((1.0, 1, 0)))),
    )
    assert np.isfinite(world.triangles.shape).all()


def test_a_world_without_triangles_has_none():
    world = world_of(h.Object(name="empty", mesh=h.Mesh(name="empty", vertices=np.zeros((3, 0)), triangles=np.zeros((3, 0)))))
    assert world.triangles.material.size == 0
    assert world.accel.is_empty


def test_geometry_beyond_memory_is_refused_by_the_scene(monkeypatch):
    monkeypatch.setattr(memory, "free", lambda: 10_000)
    told = r"scene 'Scene': its 30 triangles, most of them 20 of object 'icosphere', need about .* MiB of memory, .*: simplify or leave out"
    with pytest.raises(MemoryShortage, match=told):
        world_of(h.thing(h.quad()), *[h.thing(h.quad(name=f"quad {i}")) for i in range(4)], h.thing(h.icosphere(0)))


def test_lobes_of_one_kind_in_one_material_get_a_slot_each():
    two = Material(name="two", lobes=(Phong((0.2,) * 3, 3.0), Phong((0.3,) * 3, 30.0)))
    world = world_of(h.thing(h.quad()), h.thing(h.quad((0, 0, 2)), two))
    assert [lobe.bsdf.key for lobe in world.materials.lobes] == ["lambert", "phong", "phong"]


def test_pieces_are_measured_as_all_at_once(monkeypatch):
    """Mirrored, flat, smooth and shining meshes, one triangle without an area, one with a corner that is not finite."""
    sphere, torn = h.icosphere(1, smooth=True), np.array([[0, 1, 0, 0, np.nan], [0, 0, 1, 0, 0], [0, 0, 0, 0, 0]])
    rags = h.Mesh(name="rags", vertices=torn, triangles=np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]]).T)
    glow = Material(name="glow", emission=(1.0, 2.0, 3.0))
    objects = [
        h.thing(h.icosphere(1), glow),
        h.thing(rags, matrix=h.affine(np.eye(3), (3, 0, 0))),
        h.thing(sphere, matrix=h.affine(np.diag((-1.0, 1, 1)), (0, 3, 0))),
        h.thing(sphere, matrix=h.affine(h.rotation(1), (0, 0, 3))),
    ]
    whole = world_of(*objects)
    monkeypatch.setattr(compile, "AT_ONCE", 7)
    pieces = world_of(*objects)
    assert whole.triangles.first_emitter < whole.triangles.first_moving == 241
    for name in ("shape", "extent", "smooth", "corner_normals", "material"):
        assert h.same_bits(getattr(whole.triangles, name), getattr(pieces.triangles, name))


def test_more_vertices_than_embree_can_count_are_refused(monkeypatch):
    monkeypatch.setattr(compile, "_starts", lambda parts: np.array([0, 2**31]))
    with pytest.raises(SceneError, match="2147483648 vertices"):
        world_of(h.thing(h.icosphere(1)))
