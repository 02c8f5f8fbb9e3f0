"""Attributes are those of the triangle's corners, interpolated; values are those of the object."""

import numpy as np
import pytest

from glanz.engine import Attribute, Geometry, LinearTexture, Material, Mesh, MeshAttribute, Object, ObjectValue, SceneError
from glanz.engine.world import attributes
from glanz.engine.world.texturing import TexturePoints
from glanz.tests import helpers as h

RNG = np.random.default_rng(4)
U, V = np.float32([0.2, 0.7, 0.1]), np.float32([0.3, 0.1, 0.6])


def seen(objects, texture):
    """The compiled attributes of objects that ask for `texture`, and the triangles (F,) of each."""
    asking = Material(name="asking", emission=texture)
    placed = [h.replaced(o, materials=(asking,)) for o in objects]
    world = h.plan_of(h.scene(placed), h.settings()).world
    return world, np.searchsorted(np.cumsum([o.mesh.triangles.shape[1] for o in placed]), np.arange(world.triangles.material.size), "right")


def value(world, texture, triangle):
    points = TexturePoints(world.attributes, np.full(U.size, triangle), U, V)
    return np.broadcast_to(points.value(texture), (len(points.value(texture)), U.size))


def mesh_with(values, indices=None):
    box = h.box()
    return h.replaced(box, attributes=(MeshAttribute(name="a", values=values, **({} if indices is None else {"indices": indices})),))


def interpolated(values, corners):
    """By the definition: (1 - u - v) a + u b + v c, float64."""
    a, b, c = values.astype(np.float64)[:, corners].T
    return (1 - U - V) * a[:, None] + U * b[:, None] + V * c[:, None]


def sorted_rows(rows):
    return rows[np.lexsort(rows.round(5).T)]


@pytest.mark.parametrize("domain", ["vertices", "corners", "faces"])
def test_attributes_are_interpolated_between_corners(domain):
    """Triangles may be compiled in another order: the set of what is seen is compared."""
    triangles = h.BOX_TRIANGLES
    indices = {"vertices": None, "corners": np.arange(36).reshape(3, 12), "faces": np.repeat(np.arange(12)[None], 3, axis=0)}[domain]
    values = RNG.random((3, 8 if domain == "vertices" else 36)).astype(np.float32)
    world, _ = seen([h.thing(mesh_with(values, indices))], Attribute("a"))
    found = np.stack([value(world, Attribute("a"), t).ravel() for t in range(12)])
    expected = np.stack([interpolated(values, (triangles if indices is None else indices)[:, t]).ravel() for t in range(12)])
    np.testing.assert_allclose(sorted_rows(found), sorted_rows(expected), atol=1e-6)


def test_interpolation_catches_corners_in_another_order(monkeypatch):
    at = attributes.Attribute.at
    monkeypatch.setattr(attributes.Attribute, "at", lambda self, prim, u, v: at(self, prim, v, u))
    with pytest.raises(AssertionError):
        test_attributes_are_interpolated_between_corners("corners")


def test_a_mirrored_instance_has_the_values_of_its_corners():
    """The value of an attribute that is the position is the position, wherever the winding was turned."""
    box = mesh_with(h.box().vertices)
    mirror = np.diag((-1.0, 1.0, 1.0, 1.0))
    world, _ = seen([Object(name="m", mesh=box, world_from_object=mirror)], Attribute("a"))
    for t in range(12):
        corner, e1, e2 = world.triangles.shape[:9, t].reshape(3, 3)
        p = (corner[:, None] + U * e1[:, None] + V * e2[:, None]) / world.frame.scale + world.frame.origin[:, None]
        np.testing.assert_allclose(value(world, Attribute("a"), t), p * [[-1], [1], [1]], atol=1e-5)


def test_parametric_coordinates_are_those_of_the_mesh_also_where_it_is_mirrored():
    """The first corner of each triangle is (1, 0, 0), the second (0, 1, 0), whatever has become of the winding."""
    box = mesh_with(h.box().vertices)
    for mirror in (1.0, -1.0):
        asked = LinearTexture((Geometry("parametric"), Attribute("a")), (1.0, 1.0))
        world, _ = seen([Object(name="m", mesh=box, world_from_object=np.diag((mirror, 1.0, 1.0, 1.0)))], asked)
        for t in range(12):
            p, shares = value(world, Attribute("a"), t), value(world, Geometry("parametric"), t)
            weights = np.stack((shares[0], shares[1], 1 - shares[0] - shares[1]))
            found = (np.abs(box.vertices[:, h.BOX_TRIANGLES[:, k]] @ weights - p).max() <= 1e-5 for k in range(12))
            assert any(found)


@pytest.mark.parametrize(
    ("components", "colour", "number", "alpha"),
    [(1, (0.5, 0.5, 0.5), 0.5, 1), (2, (0.5, 0.25, 0), 0.5, 1), (3, (0.5, 0.25, 0.75), 0.5, 1), (4, (0.5, 0.25, 0.75), 0.5, 0.125)],
)
def test_components_are_converted_as_in_blender(components, colour, number, alpha):
    values = np.repeat(np.float32([[0.5], [0.25], [0.75], [0.125]])[:components], 8, axis=1)
    for output, expected in (("colour", colour), ("number", number), ("alpha", alpha), ("opacity", alpha)):
        world, _ = seen([h.thing(mesh_with(values))], Attribute("a", output))
        assert value(world, Attribute("a", output), 3)[:, 0] == pytest.approx(expected)


@pytest.mark.parametrize(("output", "expected"), [("colour", 0), ("number", 0), ("alpha", 1), ("opacity", 0)])
def test_what_a_mesh_lacks_is_0_and_there(output, expected):
    world, _ = seen([h.thing(h.box())], Attribute("lost", output))
    assert (value(world, Attribute("lost", output), 5) == expected).all()


def test_values_are_those_of_the_object():
    boxes = [
        Object(name=str(i), mesh=h.box(), values=(("x", (i, 2 * i, 3 * i, 0.5)),), world_from_object=h.affine(translation=(i, 9, 0)))
        for i in range(3)
    ]
    for output, expected in (("colour", (1, 2, 3)), ("number", 1), ("mean", 2), ("alpha", 0.5)):
        world, owner = seen(boxes, ObjectValue("x", output))
        assert value(world, ObjectValue("x", output), int(np.nonzero(owner == 1)[0][0]))[:, 1] == pytest.approx(expected)
    world, owner = seen(boxes, ObjectValue())
    for i in range(3):
        assert value(world, ObjectValue(), int(np.nonzero(owner == i)[0][0]))[:, 1] == pytest.approx((i, 9, 0))
    world, _ = seen(boxes, ObjectValue("y"))
    assert (value(world, ObjectValue("y"), 0) == 0).all()


def test_nobody_pays_for_attributes_that_nobody_asks_for():
    world, _ = seen([h.thing(mesh_with(RNG.random((3, 8))))], ObjectValue())
    assert list(world.attributes) == [("value", "location")]
    assert h.plan_of(h.scene([h.thing(h.box())]), h.settings()).world.attributes == {}


@pytest.mark.parametrize(
    ("attribute", "word"),
    [
        ({"values": np.zeros((5, 8))}, "components"),
        ({"values": np.zeros((1, 7))}, "8 vertices"),
        ({"values": np.zeros((1, 7)), "indices": np.zeros((3, 5))}, "12 triangles"),
        ({"values": np.zeros((1, 7)), "indices": np.full((3, 12), 7)}, "0 to 6"),
    ],
)
def test_attributes_that_do_not_fit_are_refused_by_name(attribute, word):
    with pytest.raises(SceneError, match=word) as error:
        h.replaced(h.box(), attributes=(MeshAttribute(name="lost", **attribute),))
    assert "'lost'" in str(error.value)


@pytest.mark.parametrize("values", [(("a", (1, 2, 3)),), (("a", "red"),), ("a",)])
def test_values_that_are_not_four_numbers_are_refused(values):
    with pytest.raises(SceneError, match="four numbers"):
        Object(name="o", mesh=Mesh(name="m", vertices=np.zeros((3, 3)), triangles=[[0], [1], [2]]), values=values)
