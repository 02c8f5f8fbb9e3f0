"""Embree behind its guard: right answers to good rays, and clear ones to bad input (catalogue A1, A6, A13; A12 in test_accel_bad_input)."""

import sys
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from glanz.engine import memory
from glanz.engine.constants import EPS32
from glanz.engine.errors import AccelError, MemoryShortage
from glanz.engine.world import accel as module
from glanz.engine.world.accel import RAYS_PER_CALL, Accel
from glanz.tests import chance, helpers as h


def random_triangles(n, seed=1, scale=1.0):
    """Vertices (3, 3 n) float32 and triangles (3, n): separate triangles of all orientations, about `scale` large."""
    rng = np.random.default_rng(seed)
    middle = rng.uniform(-1, 1, (3, n, 1))
    vertices = scale * (middle + 0.3 * rng.standard_normal((3, n, 3)))
    return vertices.reshape(3, -1).astype(np.float32), np.arange(3 * n).reshape(n, 3).T


def random_rays(n, seed=2, scale=1.0):
    rng = np.random.default_rng(seed)
    o = scale * rng.uniform(-2, 2, (3, n))
    target = scale * rng.uniform(-1, 1, (3, n))
    d = target - o
    return o.astype(np.float32), (d / np.linalg.norm(d, axis=0)).astype(np.float32)


def moeller_trumbore(v0, e1, e2, o, d):
    """(t, u, v) by Cramer's rule, for numbers of any kind with exact or rounded arithmetic."""

    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    def dot(a, b):
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

    s = tuple(o[i] - v0[i] for i in range(3))
    across = cross(d, e2)
    determinant = dot(e1, across)
    along = cross(s, e1)
    return dot(e2, along) / determinant, dot(s, across) / determinant, dot(d, along) / determinant


def corners(vertices, triangles, prim):
    """First corner and the edges, (3, N) float64 each."""
    v = vertices.astype(np.float64)[:, triangles[:, prim]]
    return v[:, 0], v[:, 1] - v[:, 0], v[:, 2] - v[:, 0]


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_the_nearest_of_many_triangles_is_found(scale):
    """A1 by brute force in float64: 20 000 rays at 60 triangles. Rays within 1e-5 of an edge or a tie may go either way."""
    vertices, triangles = random_triangles(60, scale=scale)
    o, d = random_rays(20_000, scale=scale)
    hits = Accel(vertices, triangles).closest(o, d)
    v0, e1, e2 = (a[:, :, None] for a in corners(vertices, triangles, np.arange(60)))
    t, u, v = moeller_trumbore(v0, e1, e2, o[:, None].astype(float), d[:, None].astype(float))
    inside = np.minimum(np.minimum(u, v), 1 - u - v)
    met = (inside >= 0) & (t > 0)
    doubtful = ((np.abs(inside) < 1e-5) & (t > 0)).any(axis=0)
    distance = np.sort(np.where(met, t, np.inf), axis=0)
    with np.errstate(invalid="ignore"):
        doubtful |= distance[1] - distance[0] < 1e-5 * scale
    expected = np.where(met.any(axis=0), np.where(met, t, np.inf).argmin(axis=0), -1)
    assert doubtful.mean() < 0.01
    assert (hits.prim == expected)[~doubtful].all()
    assert (hits.prim >= 0).mean() > 0.2
    lanes = np.nonzero(~doubtful & (expected >= 0))[0]
    limit = distance[0][lanes]
    accel = Accel(vertices, triangles)
    assert accel.occluded(o[:, lanes], d[:, lanes], (limit * 1.001).astype(np.float32)).all()
    assert not accel.occluded(o[:, lanes], d[:, lanes], (limit * 0.999).astype(np.float32)).any()


def check_points(point_of, n=400):
    """A1: the point of each hit against rational arithmetic: within 4 eps (coordinate + extent) of the triangle's plane."""
    vertices, triangles = random_triangles(60)
    o, d = random_rays(n, seed=3)
    o -= 100 * d  # from far away, where o + t d is at its worst
    hits = Accel(vertices, triangles).closest(o, d)
    lanes = np.nonzero(hits.prim >= 0)[0]
    assert lanes.size > n / 4
    v0, e1, e2 = corners(vertices, triangles, hits.prim[lanes])
    p = point_of(hits, lanes, v0.astype(np.float32), e1.astype(np.float32), e2.astype(np.float32), o[:, lanes], d[:, lanes]).astype(
        np.float64
    )
    normal = np.cross(e1.T, e2.T).T
    off = np.abs(h.dots(p - v0, normal / np.linalg.norm(normal, axis=0)))
    size = np.abs(p).max(axis=0) + np.maximum(np.abs(e1), np.abs(e2)).max(axis=0)
    assert (off <= 4 * EPS32 * size).all()


def barycentric(hits, lanes, v0, e1, e2, o, d):
    return v0 + hits.u[lanes] * e1 + hits.v[lanes] * e2


def test_points_lie_on_their_triangles_whatever_the_distance():
    check_points(barycentric)


def test_the_plane_catches_points_along_the_ray():
    """The mutant o + t d is 340 eps off from a hundred sizes away."""
    with pytest.raises(AssertionError):
        check_points(lambda hits, lanes, v0, e1, e2, o, d: o + hits.t[lanes] * d)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_distance_and_barycentrics_agree_with_rational_arithmetic(scale):
    """A1: 300 rays in exact fractions; t to 40 eps where cos > 0.1, u and v to 100 eps (measured: 20 and 18)."""
    vertices, triangles = random_triangles(60, scale=scale)
    o, d = random_rays(600, seed=5, scale=scale)
    hits = Accel(vertices, triangles).closest(o, d)
    v0, e1, e2 = corners(vertices, triangles, np.maximum(hits.prim, 0))
    normal = np.cross(e1.T, e2.T).T
    cos = np.abs(h.dots(normal / np.linalg.norm(normal, axis=0), d))
    lanes = np.nonzero((hits.prim >= 0) & (cos > 0.1))[0][:300]
    assert lanes.size > 100
    for i in lanes:
        exact = [tuple(Fraction(float(x)) for x in a[:, i]) for a in (v0, e1, e2, o, d)]
        t, u, v = map(float, moeller_trumbore(*exact))
        assert abs(hits.t[i] / t - 1) <= 40 * EPS32
        assert abs(hits.u[i] - u) <= 100 * EPS32
        assert abs(hits.v[i] - v) <= 100 * EPS32


def leaks(mesh, kind, offset=0.0, n=100_000, seed=7):
    """The share of rays from inside a closed mesh, aimed at random, at edges or at vertices, that meet nothing."""
    vertices = (np.asarray(mesh.vertices, np.float64) + offset).astype(np.float32)
    triangles = mesh.triangles
    rng = np.random.default_rng(seed)
    prim = rng.integers(0, triangles.shape[1], n)
    a, b, c = vertices[:, triangles[:, prim]].astype(np.float64).transpose(1, 0, 2)
    s = rng.random(n)
    if kind == "edge":
        target = a + s * (b - a)
    elif kind == "vertex":
        target = a
    else:
        r = np.sqrt(rng.random(n))
        target = a + r * (b - a) + r * s * (c - b)
    middle = vertices.astype(np.float64).mean(axis=1, keepdims=True)
    size = np.abs(vertices.astype(np.float64) - middle).max()
    o = (middle + 0.3 * size * h.directions(seed + 1, n) * rng.random(n)).astype(np.float32)
    d = target - o
    d = (d / np.linalg.norm(d, axis=0)).astype(np.float32)
    return np.count_nonzero(Accel(vertices, triangles).closest(o, d).prim < 0) / n


def star():
    """A closed, bumpy, generic mesh."""
    mesh = h.icosphere(2)
    bump = 1 + 0.4 * np.random.default_rng(3).random(mesh.vertices.shape[1])
    return h.Mesh(name="star", vertices=h.rotation(5) @ (mesh.vertices * bump), triangles=mesh.triangles)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@chance.fresh
def test_closed_meshes_hold_rays_in(scale):
    """A6: 0 of 1e5 random and of 1e5 edge-aimed rays leak, at most 2e-3 of those aimed at vertices; at each scale."""
    mesh = star()
    scaled = h.Mesh(name="scaled", vertices=mesh.vertices * scale, triangles=mesh.triangles)
    assert leaks(scaled, "random") == 0
    assert leaks(scaled, "edge") == 0
    assert leaks(scaled, "vertex") <= 2e-3


def test_closed_meshes_far_from_the_origin_hold_rays_in():
    """A6 with an offset of a thousand sizes: 0 leaks; rebasing keeps it smaller than that."""
    assert leaks(star(), "random", offset=1e3) == 0
    assert leaks(star(), "edge", offset=1e3) == 0


def test_holding_in_catches_embree_without_robustness(monkeypatch):
    """The mutant leaks 7 % of the rays aimed at edges."""
    rtcore, rtcore_scene, mesh_construction = module._embreex()
    fragile = SimpleNamespace(
        EmbreeScene=lambda device, robust: rtcore_scene.EmbreeScene(device, robust=False), __file__=rtcore_scene.__file__
    )
    monkeypatch.setattr(module, "_embreex", lambda: (rtcore, fragile, mesh_construction))
    assert leaks(star(), "edge", n=20_000) > 0.01


def test_rays_that_are_not_finite_meet_nothing_and_disturb_no_others():
    """A13: one ray in a hundred with NaN or inf in each possible place; the rest is bit-identical."""
    vertices, triangles = random_triangles(200)
    accel = Accel(vertices, triangles)
    o, d = random_rays(6_000)
    clean = accel.closest(o, d)
    limit = np.full(6_000, 1.5, np.float32)
    clean_blocked = accel.occluded(o, d, limit)
    bad_o, bad_d = o.copy(), d.copy()
    lanes = np.arange(0, 6_000, 100)
    for i, lane in enumerate(lanes):
        (bad_o, bad_d)[i % 2][i % 3, lane] = (np.nan, np.inf, -np.inf)[i // 6 % 3]
    hits, blocked = accel.closest(bad_o, bad_d), accel.occluded(bad_o, bad_d, limit)
    assert (hits.prim[lanes] == -1).all()
    assert not blocked[lanes].any()
    rest = np.setdiff1d(np.arange(6_000), lanes)
    for name in ("prim", "u", "v"):
        assert h.same_bits(getattr(hits, name)[rest], getattr(clean, name)[rest])
    assert h.same_bits(hits.t[rest][clean.prim[rest] >= 0], clean.t[rest][clean.prim[rest] >= 0])
    assert (blocked[rest] == clean_blocked[rest]).all()


def test_results_do_not_depend_on_batches_or_order():
    vertices, triangles = random_triangles(200)
    accel = Accel(vertices, triangles)
    n = RAYS_PER_CALL + 1_000
    o, d = random_rays(n)
    whole = accel.closest(o, d)
    order = np.random.default_rng(1).permutation(n)
    mixed = accel.closest(np.ascontiguousarray(o[:, order]), np.ascontiguousarray(d[:, order]))
    for name in ("prim", "t", "u", "v"):
        assert h.same_bits(getattr(whole, name)[order], getattr(mixed, name))
    part = accel.closest(o[:, :3], d[:, :3])
    assert h.same_bits(whole.prim[:3], part.prim)
    limit = np.full(n, 1.0, np.float32)
    assert (accel.occluded(o, d, limit)[-3:] == accel.occluded(o[:, -3:], d[:, -3:], limit[-3:])).all()


def test_limits_are_not_written_to():
    accel = Accel(*random_triangles(20))
    o, d = random_rays(1_000)
    limit = np.linspace(0, 3, 1_000, dtype=np.float32)
    limit.flags.writeable = o.flags.writeable = d.flags.writeable = False
    accel.occluded(o, d, limit)
    accel.closest(o, d)


def test_memory_that_is_not_there_is_refused_before_it_is_taken(monkeypatch):
    needed = 20 * module.BYTES_PER_TRIANGLE
    monkeypatch.setattr(memory, "free", lambda: 2 * needed - 1)
    with pytest.raises(MemoryShortage, match=r"20 triangles need about 0\.0 MiB of memory, but only 0\.0 MiB are free: simplify the scene"):
        Accel(*random_triangles(20))
    monkeypatch.setattr(memory, "free", lambda: 2 * needed)
    Accel(*random_triangles(20))


def test_a_machine_that_does_not_tell_its_memory_is_trusted(monkeypatch):
    monkeypatch.setattr(memory, "free", lambda: None)
    Accel(*random_triangles(20))


def test_a_missing_embreex_is_named_with_the_cure(monkeypatch):
    monkeypatch.setitem(sys.modules, "embreex", None)
    with pytest.raises(AccelError, match=r"embreex cannot be loaded .* install the package embreex"):
        module._embreex()
