"""Scene values are checked when they are made: each error names the thing and the value."""

import dataclasses

import numpy as np
import pytest

from glanz.engine import Lambert, Material, Mesh, Object, PerspectiveCamera, Scene, SceneError, World
from glanz.tests import helpers as h

V = np.eye(3)
T = np.array([[0], [1], [2]])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"vertices": np.zeros((2, 3))}, r"mesh 'm': vertices has shape \(2, 3\), expected \(3, any\)"),
        ({"vertices": np.zeros(3)}, r"mesh 'm': vertices has shape \(3,\), expected \(3, any\)"),
        ({"vertices": "corners"}, "mesh 'm': vertices is not an array of numbers"),
        ({"triangles": T.T}, r"mesh 'm': triangles has shape \(1, 3\), expected \(3, any\)"),
        ({"triangles": T + 1}, "mesh 'm': triangles reach from 1 to 3, allowed: 0 to 2"),
        ({"triangles": T - 1}, "mesh 'm': triangles reach from -1 to 1, allowed: 0 to 2"),
        ({"normals": np.zeros((3, 2)), "normal_indices": T}, "mesh 'm': normal_indices reach from 0 to 2, allowed: 0 to 1"),
        ({"normals": V, "normal_indices": np.zeros((3, 2), int)}, "mesh 'm': normal_indices must have one entry for each of 1 triangles"),
        ({"material_indices": [0, 1]}, "mesh 'm': material_indices must have one entry for each of 1 triangles"),
        ({"material_indices": [[0]]}, r"mesh 'm': material_indices has shape \(1, 1\), expected \(any\)"),
        ({"triangles": T.astype(np.int64) + 2**40}, r"mesh 'm': triangles are not all whole numbers below 2\^31"),
        ({"triangles": T + 0.5}, "mesh 'm': triangles are not all whole numbers"),
        ({"shapes": np.zeros((2, 3, 4))}, r"mesh 'm': shapes have shape \(2, 3, 4\), expected \(any, 3, 3\)"),
        ({"shapes": np.zeros((3, 3))}, r"mesh 'm': shapes has shape \(3, 3\), expected \(any, 3, any\)"),
        ({"shape_normals": np.zeros((2, 3, 0))}, "mesh 'm': 0 shapes, but 2 shape_normals"),
        ({"triangles": T * np.nan}, "mesh 'm': triangles are not all whole numbers"),
    ],
    ids=lambda x: next(iter(x)) if isinstance(x, dict) else "",
)
def test_a_bad_mesh_is_refused_by_name(changes, message):
    with pytest.raises(SceneError, match=message):
        Mesh(**{"name": "m", "vertices": V, "triangles": T, **changes})


def test_a_bad_transform_is_refused_by_name():
    mesh = Mesh(name="m", vertices=V, triangles=T)
    with pytest.raises(SceneError, match=r"object 'chair': world_from_object has shape \(3, 3\), expected \(4, 4\)"):
        Object(name="chair", mesh=mesh, world_from_object=np.eye(3))


def test_a_bad_motion_is_refused_by_name():
    mesh = Mesh(name="m", vertices=V, triangles=T)
    for motion in (np.eye(4), np.zeros((2, 3, 4)), "left"):
        with pytest.raises(SceneError, match="object 'chair': motion "):
            Object(name="chair", mesh=mesh, motion=motion)
        with pytest.raises(SceneError, match="camera 'Eye': motion "):
            PerspectiveCamera(name="Eye", motion=motion)


def test_what_moves_stands_where_it_is_at_the_middle_of_the_shutter():
    mesh = Mesh(name="m", vertices=V, triangles=T)
    keys = np.stack([h.affine(translation=(x, 0, 0)) for x in (1, 2, 5, 6)])
    for thing in (Object(name="o", mesh=mesh, motion=keys), PerspectiveCamera(motion=keys)):
        matrix = thing.world_from_object if isinstance(thing, Object) else thing.world_from_camera
        np.testing.assert_allclose(matrix, h.affine(translation=(3.5, 0, 0)), atol=1e-12)
    shaped = Mesh(name="m", vertices=V, triangles=T, shapes=np.stack([V, 3 * V]), normals=V, shape_normals=np.stack([V, 2 * V]))
    assert h.same_bits(shaped.vertices, 2 * V)
    assert shaped.deforms
    np.testing.assert_array_equal(shaped.at(0.25).vertices, 1.5 * V)
    np.testing.assert_array_equal(shaped.at(0.25).normals, np.float32(1.25) * V)
    assert not shaped.at(0.25).deforms


def test_keys_that_are_all_the_same_are_no_motion():
    there = h.affine(translation=(1, 2, 3))
    o = Object(name="o", mesh=Mesh(name="m", vertices=V, triangles=T, shapes=np.stack([2 * V] * 3)), motion=np.stack([there] * 2))
    assert o.is_still
    assert o.motion.shape == (0, 4, 4)
    np.testing.assert_array_equal(o.world_from_object, there)
    np.testing.assert_array_equal(o.mesh.vertices, 2 * V)
    camera = PerspectiveCamera(motion=there[None])
    assert not len(camera.motion)
    np.testing.assert_array_equal(camera.world_from_camera, there)


def test_values_cannot_be_changed():
    mesh = Mesh(name="m", vertices=V, triangles=T)
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0, 0] = 5
    for value in (mesh, Material(name="a"), World(), h.scene(), Object(name="o", mesh=mesh)):
        with pytest.raises(dataclasses.FrozenInstanceError):
            value.name = "other"


def test_vertices_keep_float64_and_else_become_float32():
    for given, kept in ((np.float64, np.float64), (np.float32, np.float32), (np.float16, np.float32), (int, np.float32)):
        assert Mesh(name="m", vertices=V.astype(given), triangles=T).vertices.dtype == kept
    assert Mesh(name="m", vertices=V.tolist(), triangles=T.tolist()).vertices.dtype == np.float32


def test_arrays_that_fit_are_not_copied():
    v = np.ascontiguousarray(V, np.float32)
    assert np.shares_memory(Mesh(name="m", vertices=v, triangles=T).vertices, v)


def test_sequences_become_tuples():
    scene = Scene(camera=None, objects=[], lights=[])
    assert scene.objects == scene.lights == ()
    assert Material(name="m", lobes=[Lambert()]).lobes == (Lambert(),)
    assert Material(name="m", emission=np.array([1, 2, 3])).emission == (1.0, 2.0, 3.0)
    assert World(radiance=[1, 2, 3]).radiance == (1.0, 2.0, 3.0)


def test_an_empty_mesh_is_a_mesh():
    mesh = Mesh(name="m", vertices=np.zeros((3, 0)), triangles=np.zeros((3, 0)))
    assert mesh.triangles.shape == (3, 0)
    assert not mesh.is_smooth
