"""How surfaces face the viewer, against float64 and geometry."""

import numpy as np
import pytest

from glanz.engine.maths import facing
from glanz.engine.maths.tangents import corner_tangents
from glanz.engine.maths.vectors import cross, dot
from glanz.tests import helpers as h, textured as t

N = h.directions(1, 500, np.float32)
D = h.directions(2, 500, np.float32)


def exact_fresnel(cos, eta):
    """By Snell's angles (Born & Wolf, 1.5.2, eq. 21a), float64."""
    i = np.arccos(np.abs(cos.astype(np.float64)))
    with np.errstate(invalid="ignore"):
        t = np.arcsin(np.sin(i) / eta)
        share = 0.5 * ((np.sin(i - t) / np.sin(i + t)) ** 2 + (np.tan(i - t) / np.tan(i + t)) ** 2)
    return np.where(np.isnan(share), 1, share)


@pytest.mark.parametrize("ior", [0.7, 1.1, 1.5, 4.0])
def test_facing_fresnel_is_that_of_the_angles_from_both_sides(ior):
    cos = np.linspace(0.01, 0.999, 300).astype(np.float32)
    np.testing.assert_allclose(facing.facing_fresnel(cos, np.float32(ior), True), exact_fresnel(cos, ior), atol=3e-5)
    np.testing.assert_allclose(facing.facing_fresnel(-cos, np.float32(ior), False), exact_fresnel(cos, 1 / ior), atol=3e-5)


@pytest.mark.parametrize(("blend", "exponent"), [(0.0, 0.0), (0.25, 0.5), (0.5, 1.0), (0.75, 2.0), (0.9, 5.0)])
def test_facing_is_a_power_of_the_cosine(blend, exponent):
    cos = np.linspace(-1, 1, 101).astype(np.float32)
    np.testing.assert_allclose(facing.schlick_facing(cos, np.float32(blend)), 1 - np.abs(cos.astype(float)) ** exponent, atol=1e-6)


def test_extreme_blends_and_indices_stay_finite():
    cos = np.float32([0, 1e-30, 1, -1])
    for blend in (-1e30, 0, 1, 1e30):
        assert np.isfinite(facing.schlick_facing(cos, np.float32(blend))).all()
        for is_front in (True, False):
            assert np.isfinite(facing.facing_fresnel(cos, np.float32(blend), is_front)).all()


def test_mirrored_directions_leave_as_they_came():
    m = facing.mirrored(D, N)
    np.testing.assert_allclose(dot(m, N), -dot(D, N), atol=1e-6)
    np.testing.assert_allclose(cross(m, N), cross(D, N), atol=1e-6)


def test_sides_are_unit_and_orthogonal_also_where_three_components_are_equal():
    n = np.concatenate((N, np.full((3, 1), 3**-0.5, np.float32), np.full((3, 1), -(3**-0.5), np.float32)), axis=1)
    right, up = facing.across(n)
    for a, b, product in ((right, right, 1), (up, up, 1), (right, up, 0), (right, n, 0), (up, n, 0)):
        np.testing.assert_allclose(dot(a, b), product, atol=1e-6)


def test_a_raised_plane_has_the_normal_of_its_slope():
    """z = a x + b y has the normal (-a, -b, 1), however the sides are turned."""
    n = np.float32([[0], [0], [1]])
    right, up = facing.across(n)
    slope = np.float32([0.3, -0.7, 0])
    found = facing.raised(n, right, up, [slope @ right, slope @ up], np.float32(1))
    np.testing.assert_allclose(found[:, 0], np.float64([-0.3, 0.7, 1]) / np.sqrt(1.58), atol=1e-6)


def test_tangents_are_where_u_grows_and_smooth_where_corners_are_shared():
    """On a ball with u about z: along the parallels; at shared corners the same for all triangles."""
    ball = h.icosphere(3, smooth=True)
    x, y, z = ball.vertices
    keep = (np.abs(z[ball.triangles]) < 0.8).all(axis=0) & (x[ball.triangles] > 0.1).all(axis=0)
    part = h.replaced(ball, triangles=ball.triangles[:, keep], normal_indices=ball.normal_indices[:, keep])
    part = t.with_uvs(part, np.stack((np.arctan2(y, x), z)))
    found, indices = corner_tangents(part, part.uvs[0])
    expected = facing.unit(facing.around(part.vertices.astype(np.float32) + 0.5, "z")).take(part.triangles.ravel(), axis=1)
    assert (dot(found[:3, indices.ravel()], expected) > 0.98).all()
    assert (found[3] == 1).all()
    for vertex in np.unique(part.triangles)[:50]:
        own = found[:, indices.ravel()[part.triangles.ravel() == vertex]]
        np.testing.assert_allclose(own, own[:, :1] + 0 * own, atol=1e-12)


def test_tangents_know_the_hand_of_mirrored_coordinates():
    quad = t.with_uvs(h.quad(), ((1, 0, 0, 1), (0, 0, 1, 1)))
    found, _ = corner_tangents(quad, quad.uvs[0])
    np.testing.assert_allclose(found, np.repeat([[-1.0], [0], [0], [-1]], 6, axis=1), atol=1e-12)


def test_tangents_without_coordinates_to_span_them_are_0():
    quad = t.with_uvs(h.quad(), ((0.5,) * 4, (0.5,) * 4))
    assert (corner_tangents(quad, quad.uvs[0])[0][:3] == 0).all()
