"""Vertex normals of meshes that bring none, against closed forms."""

import math

import numpy as np
import pytest

from glanz.engine import Mesh, SceneError
from glanz.engine.maths import normals
from glanz.tests import helpers as h


def corner_normals(mesh):
    """(3, 3, F): the normal of each corner of each triangle."""
    return mesh.normals[:, mesh.normal_indices].astype(np.float64)


def grid(heights, size=1.0):
    """A surface over a square lattice of unit cells, (N, N) heights, two triangles to a cell."""
    n = len(heights)
    x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = index[:-1, :-1].ravel(), index[1:, :-1].ravel(), index[1:, 1:].ravel(), index[:-1, 1:].ravel()
    vertices = np.stack((x.ravel() * size, y.ravel() * size, np.ravel(heights)))
    return Mesh(name="grid", vertices=vertices, triangles=np.concatenate((np.stack((a, b, c)), np.stack((a, c, d))), axis=1))


def uneven_corner(n):
    """A corner of three faces at vertex 0: the quarter of a disk, cut into n slivers, and two single triangles."""
    fan = np.linspace(0, math.pi / 2, n + 1)
    rim = [(math.cos(t), math.sin(t), 0) for t in fan]
    points = np.array([(0, 0, 0), *rim, (0, 0, 1)], float).T
    top = len(rim) + 1
    faces = [(0, 1 + i, 2 + i) for i in range(n)] + [(0, top, 1), (0, len(rim), top)]
    return Mesh(name="corner", vertices=points, triangles=np.array(faces).T)


def test_the_corners_of_a_cube_add_up_its_faces_by_area():
    """Two opposite corners have two triangles of each face, (1, 1, 1) / sqrt(3); their neighbours one, one and two."""
    mesh = h.box((-1, -1, -1), (1, 1, 1)).smoothed()
    at = {int(v): mesh.normals[:, i] for v, i in zip(mesh.triangles.ravel(), mesh.normal_indices.ravel())}
    for corner, sums in ((0, (-1, -1, -1)), (7, (1, 1, 1)), (1, (-1, -1, 2)), (4, (2, -1, -1))):
        np.testing.assert_allclose(at[corner], np.array(sums) / np.linalg.norm(sums), atol=1e-7)


@pytest.mark.parametrize("degrees", [0, 30, 89.99])
def test_a_cube_keeps_its_edges_below_a_right_angle(degrees):
    """Three normals at each corner, and each is that of its face: 24 in all."""
    mesh = h.box().smoothed(math.radians(degrees))
    face = normals.area_normals(mesh.vertices, mesh.triangles)
    face /= np.linalg.norm(face, axis=0)
    np.testing.assert_allclose(corner_normals(mesh), np.broadcast_to(face[:, None], (3, 3, 12)), atol=1e-7)
    assert mesh.normals.shape[1] == 24


@pytest.mark.parametrize("degrees", [90, 180])
def test_a_cube_is_smooth_from_a_right_angle_on(degrees):
    assert h.box().smoothed(math.radians(degrees)).normals.shape[1] == 8


@pytest.mark.parametrize("radius", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize(("subdivisions", "degrees"), [(0, 1e-4), (3, 0.7)])
def test_the_normals_of_a_sphere_are_radial(radius, subdivisions, degrees):
    """An icosahedron's exactly, those of 1280 triangles to what their two sizes leave; at any scale."""
    mesh = h.icosphere(subdivisions, radius).smoothed()
    radial = h.icosphere(subdivisions).vertices[:, mesh.triangles].reshape(3, -1)
    between = np.linalg.norm(corner_normals(mesh).reshape(3, -1) - radial, axis=0)
    assert np.degrees(between).max() <= degrees
    assert np.linalg.norm(mesh.normals, axis=0) == pytest.approx(1, abs=1e-6)


def test_the_weight_is_the_area():
    """A quarter disk of 40 slivers and two triangles of 1/2: (1/2, 1/2, n/2 sin(pi / 2n)), then normalised."""
    n = 40
    mesh = uneven_corner(n).smoothed()
    disk = n / 2 * math.sin(math.pi / 2 / n)
    truth = np.array((0.5, 0.5, disk))
    found = mesh.normals[:, mesh.normal_indices[0, 0]]
    np.testing.assert_allclose(np.abs(found), truth / np.linalg.norm(truth), atol=1e-6)


def test_the_weight_catches_faces_that_count_alike(monkeypatch):
    """The mutant gives each of the 40 slivers as much weight as a whole face: it is off by 40 degrees."""
    area = normals.area_normals

    def unweighted(vertices, triangles):
        face = area(vertices, triangles)
        return face / np.maximum(np.linalg.norm(face, axis=0), 1e-300)

    monkeypatch.setattr(normals, "area_normals", unweighted)
    with pytest.raises(AssertionError):
        test_the_weight_is_the_area()


def test_a_paraboloid_has_the_normals_of_its_gradient():
    """z = x^2 + y^2 on a lattice: at inner vertices (-2x, -2y, 1) as central differences have it, exactly."""
    n, step = 9, 0.125
    at = (np.arange(n) - 4) * step
    mesh = grid(at[:, None] ** 2 + at**2, step).smoothed()
    inner = np.arange(n * n).reshape(n, n)[1:-1, 1:-1].ravel()
    x, y = np.meshgrid(at[1:-1], at[1:-1], indexing="ij")
    truth = np.stack((-2 * x.ravel(), -2 * y.ravel(), np.ones(x.size)))
    found = np.zeros((3, n * n))
    found[:, mesh.triangles.ravel()] = corner_normals(mesh).reshape(3, -1)
    np.testing.assert_allclose(found[:, inner], truth / np.linalg.norm(truth, axis=0), atol=1e-6)


def test_a_sharp_edge_divides_a_roof_and_nothing_else():
    """Two slopes of 45 degrees, each bent by 10 degrees in its middle: the ridge of 90 degrees stays, the bends are smooth."""
    x = np.array((-2, -1, 0, 1, 2), float)
    z = np.array((-1 - math.tan(math.radians(55)), -1, 0, -1, -1 - math.tan(math.radians(55))))
    vertices = np.concatenate([np.stack((x, np.full(5, y), z)) for y in (0.0, 1.0)], axis=1)
    faces = [f for i in range(4) for f in ((i, i + 1, i + 6), (i, i + 6, i + 5))]
    mesh = Mesh(name="roof", vertices=vertices, triangles=np.array(faces).T)
    sharp = mesh.smoothed(math.radians(30))
    # Ten vertices, of which the two on the ridge have two normals each.
    assert sharp.normals.shape[1] == 12
    at_ridge = np.unique(sharp.normal_indices[sharp.triangles == 2])
    np.testing.assert_allclose(sorted(sharp.normals[0, at_ridge]), (-math.sqrt(0.5), math.sqrt(0.5)), atol=1e-6)
    assert mesh.smoothed().normals.shape[1] == 10
    assert mesh.smoothed(0.0).normals.shape[1] > 12


def test_degenerate_and_broken_triangles_change_nothing():
    """Triangles without an area, with twice the same corner, or not finite beside a sphere: its normals keep their bits."""
    sphere = h.icosphere(1)
    count = sphere.vertices.shape[1]
    vertices = np.concatenate((sphere.vertices, [[np.nan], [0], [0]]), axis=1)
    odd = np.array([[0, 0, 0], [0, 0, 1], [1, 2, count]]).T
    mesh = Mesh(name="odd", vertices=vertices, triangles=np.concatenate((sphere.triangles, odd), axis=1))
    for angle in (math.pi, math.radians(60)):
        found = corner_normals(mesh.smoothed(angle))
        assert np.isfinite(found).all()
        assert np.linalg.norm(found, axis=0) == pytest.approx(1, abs=1e-6)
        assert h.same_bits(found[:, :, : sphere.triangles.shape[1]], corner_normals(sphere.smoothed(angle)))


def test_faces_that_cancel_leave_the_normal_of_one():
    """A triangle and its own back."""
    mesh = Mesh(name="two", vertices=h.rotation(1) @ np.eye(3), triangles=np.array([[0, 1, 2], [0, 2, 1]]).T)
    found = mesh.smoothed().normals
    face = normals.area_normals(mesh.vertices, mesh.triangles)[:, :1]
    np.testing.assert_allclose(np.abs(h.dots(found, face / np.linalg.norm(face))), 1, atol=1e-6)


def test_an_empty_mesh_stays_empty():
    mesh = Mesh(name="none", vertices=np.zeros((3, 0)), triangles=np.zeros((3, 0)))
    for angle in (0.5, math.pi):
        assert mesh.smoothed(angle).normal_indices.shape == (3, 0)


@pytest.mark.parametrize("angle", [-0.1, 3.2, float("nan")])
def test_senseless_angles_are_refused_by_name(angle):
    with pytest.raises(SceneError, match="mesh 'box'"):
        h.box().smoothed(angle)


@pytest.mark.parametrize("seed", range(3))
def test_components_are_those_of_a_search(seed):
    """A random graph, a long path and a long path backwards, against breadth-first search in plain Python."""
    rng = np.random.default_rng(seed)
    path = np.arange(200, 399)
    a, b = np.concatenate((rng.integers(0, 200, (2, 90)), (path, path + 1), (598 - path + 200 - 199, 598 - path + 200 - 198)), axis=1)
    label = normals.components(600, a, b)
    neighbours = {i: set() for i in range(600)}
    for i, j in zip(a.tolist(), b.tolist()):
        neighbours[i].add(j)
        neighbours[j].add(i)
    for start in range(600):
        found, front = {start}, [start]
        while front:
            new = neighbours[front.pop()] - found
            found |= new
            front += new
        assert label[start] == min(found)
