"""Meshes arrive as the viewport shows them: triangles, normals, material slots."""

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender


def _corner_normals(o):
    """(F, 3 corners, 3) of an engine object's mesh."""
    return o.mesh.normals[:, o.mesh.normal_indices].transpose(2, 1, 0)


def _face_normals(o):
    a, b, c = (o.mesh.vertices[:, o.mesh.triangles[i]].T for i in range(3))
    n = np.cross(b - a, c - a)
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def test_polygons_become_triangles_of_the_same_area():
    blender.add_plane(size=3)
    o = blender.export_object("Plane")
    assert o.mesh.triangles.shape == (3, 2)
    np.testing.assert_allclose(_face_normals(o), [(0, 0, 1)] * 2)


def test_flat_meshes_carry_no_normals():
    blender.add_tetrahedron()
    assert not blender.export_object("Tetrahedron").mesh.is_smooth


def test_smooth_normals_are_blenders_corner_normals():
    ob = blender.add_tetrahedron()
    ob.data.shade_smooth()
    normals = _corner_normals(blender.export_object("Tetrahedron"))
    expected = [[ob.data.corner_normals[i].vector for i in t.loops] for t in ob.data.loop_triangles]
    np.testing.assert_array_equal(normals, np.array(expected, np.float32))
    # At the corner of the three square faces all share one normal.
    np.testing.assert_allclose(normals[0][0], np.array((-1, -1, -1)) / 3**0.5, atol=1e-6)


def test_normals_of_vertices_where_no_edge_is_sharp_and_else_of_corners():
    ob = blender.add_tetrahedron()
    ob.data.shade_smooth()
    mesh = blender.export_object("Tetrahedron").mesh
    assert mesh.normals.shape == mesh.vertices.shape
    np.testing.assert_array_equal(mesh.normal_indices, mesh.triangles)
    ob.data.edges[0].use_edge_sharp = True
    assert blender.export_object("Tetrahedron").mesh.normals.shape == (3, len(ob.data.loops))


def test_concave_faces_have_the_triangles_and_materials_that_blender_shows():
    ob = blender.add_plane()
    ob.data.vertices[0].co = ob.data.vertices[3].co * 0.5
    for name in "ab":
        ob.data.materials.append(bpy.data.materials.new(name))
    assert blender.export_object("Plane").mesh.material_indices.size == 0
    ob.data.polygons[0].material_index = 1
    mesh = blender.export_object("Plane").mesh
    ob.data.calc_loop_triangles()
    np.testing.assert_array_equal(mesh.triangles.T, [t.vertices for t in ob.data.loop_triangles])
    np.testing.assert_array_equal(mesh.material_indices, [1, 1])


def test_sharp_edges_split_normals():
    ob = blender.add_tetrahedron()
    ob.data.shade_smooth()
    for edge in ob.data.edges:
        edge.use_edge_sharp = 3 not in edge.vertices
    o = blender.export_object("Tetrahedron")
    normals, faces = _corner_normals(o), _face_normals(o)
    np.testing.assert_allclose(normals[0], [faces[0]] * 3, atol=1e-6)
    at_tip = normals[np.array(o.mesh.triangles.T) == 3]
    np.testing.assert_allclose(at_tip, [at_tip[0]] * 3, atol=1e-6)
    assert not np.allclose(at_tip, faces[1:], atol=0.1)


def test_one_smooth_face_among_flat_ones_keeps_its_normals():
    ob = blender.add_tetrahedron()
    ob.data.polygons[0].use_smooth = True
    o = blender.export_object("Tetrahedron")
    assert o.mesh.is_smooth
    np.testing.assert_allclose(_corner_normals(o)[1:], np.repeat(_face_normals(o)[1:, None], 3, axis=1), atol=1e-6)


def test_custom_normals_are_kept():
    ob = blender.add_plane()
    ob.data.shade_smooth()
    n = np.array((0.6, 0, 0.8))
    ob.data.normals_split_custom_set([n] * 4)
    # Blender stores them in 16 bits.
    np.testing.assert_allclose(_corner_normals(blender.export_object("Plane")), np.broadcast_to(n, (2, 3, 3)), atol=1e-3)


def test_modifiers_count():
    ob = blender.add_plane()
    array = ob.modifiers.new("Array", "ARRAY")
    array.count = 3
    o = blender.export_object("Plane")
    assert o.mesh.triangles.shape == (3, 6)
    assert np.ptp(o.mesh.vertices[0]) == pytest.approx(6)


def test_material_indices_name_slots():
    ob = blender.add_tetrahedron()
    for name in ("A", "B"):
        ob.data.materials.append(bpy.data.materials.new(name))
    ob.data.polygons[2].material_index = 1
    o = blender.export_object("Tetrahedron")
    np.testing.assert_array_equal(o.mesh.material_indices, [0, 0, 1, 0])
    assert [m.name for m in o.materials] == ["A", "B"]


def test_vertices_that_are_not_finite_reach_the_engine_which_drops_their_triangles():
    ob = blender.add_tetrahedron()
    ob.data.vertices[3].co.z = float("nan")
    o = blender.export_object("Tetrahedron")
    assert np.isnan(o.mesh.vertices).sum() == 1


def test_meshes_without_faces_are_left_out():
    blender.link("Points", blender.new_mesh("Points", [(0, 0, 0), (1, 0, 0)], []))
    assert blender.export()[0].objects == ()


def test_users_mesh_is_not_touched():
    ob = blender.add_tetrahedron()
    before = np.empty(12, np.float32), len(bpy.data.meshes), len(bpy.data.objects)
    ob.data.vertices.foreach_get("co", before[0])
    blender.add_camera()
    count = len(bpy.data.objects)
    blender.export_object("Tetrahedron")
    after = np.empty(12, np.float32)
    ob.data.vertices.foreach_get("co", after)
    np.testing.assert_array_equal(before[0], after)
    assert (before[1], count) == (len(bpy.data.meshes), len(bpy.data.objects))
