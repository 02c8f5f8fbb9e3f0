"""Hits in double precision: measured on the triangle, refused where Embree was wrong, and found anew (catalogue A1, A4, A8)."""

from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from glanz.engine import render_image
from glanz.engine.constants import EPS32
from glanz.engine.world import measured
from glanz.engine.world.accel import Accel
from glanz.engine.world.compile import _measure
from glanz.engine.world.interaction import flat_normals, interact
from glanz.engine.world.measured import Lost, MeasuredAccel
from glanz.tests import helpers as h
from glanz.tests.chance import SEED
from glanz.tests.engine.world import test_accel
from glanz.tests.engine.world.test_accel import corners, moeller_trumbore, random_rays, random_triangles


def tree_of(vertices, triangles, real=np.float64):
    """The tree for rays of the dtype `real`, what `interact` has to know of `Triangles`, and which have an area."""
    shape, extent, _, has_area = _measure(vertices, triangles, real)
    embree = Accel(vertices, triangles)
    table = SimpleNamespace(shape=shape, extent=extent, material=np.zeros(triangles.shape[1], np.intp))
    return embree if real == np.float32 else MeasuredAccel(embree, shape, extent, Lost()), table, np.nonzero(has_area)[0]


def check_hits(scale, least_cos=1e-4, n=600):
    """A1: t, u, v of some 200 rays in exact fractions, to 1e-12 / cos of distance and extent."""
    vertices, triangles = random_triangles(60, scale=scale)
    rng = np.random.default_rng(5)
    prim = rng.integers(0, 60, n)
    v0, e1, e2 = corners(vertices, triangles, prim)
    target = v0 + 0.3 * e1 + rng.uniform(0.1, 0.6, n) * e2
    normal = np.cross(e1.T, e2.T).T
    cos = 10.0 ** rng.uniform(np.log10(least_cos), 0, n)
    d = cos * normal / np.linalg.norm(normal, axis=0) + np.sqrt(1 - cos * cos) * e1 / np.linalg.norm(e1, axis=0)
    o = target - scale * rng.uniform(0.01, 100, n) * d
    hits = tree_of(vertices, triangles)[0].closest(o, d)
    lanes = np.nonzero(hits.prim == prim)[0]
    assert lanes.size > n / 4
    for i in lanes[:200]:
        exact = [tuple(Fraction(float(x)) for x in a[:, i]) for a in (v0, e1, e2, o, d)]
        t, u, v = map(float, moeller_trumbore(*exact))
        far = 1e-12 / cos[i] * (1 + t / scale)
        assert abs(hits.t[i] - t) <= 1e-12 / cos[i] * t
        assert abs(hits.u[i] - u) <= far
        assert abs(hits.v[i] - v) <= far


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_hits_agree_with_rational_arithmetic(scale):
    check_hits(scale)


def test_rational_arithmetic_catches_what_embree_says(monkeypatch):
    """The mutant takes Embree's own t, u and v."""
    look = MeasuredAccel._look

    def unmeasured(self, start, towards, o, d, limit):
        hits, *others = look(self, start, towards, o, d, limit)
        found = self.embree.closest(o.astype(np.float32), d.astype(np.float32))
        return h.replaced(hits, t=found.t, u=found.u, v=found.v), *others

    monkeypatch.setattr(MeasuredAccel, "_look", unmeasured)
    with pytest.raises(AssertionError):
        check_hits(1.0)


def test_what_embree_meets_is_met_and_what_it_misses_is_missed():
    """At triangles of good shape no answer differs but by rounding, with and without limits."""
    vertices, triangles = random_triangles(60)
    o, d = random_rays(20_000)
    tree, *_ = tree_of(vertices, triangles)
    for limit in (None, np.full(o.shape[1], 1.5)):
        hits = tree.closest(o.astype(float), d.astype(float), limit)
        found = tree.embree.closest(o, d, None if limit is None else limit.astype(np.float32))
        assert (hits.prim == found.prim).mean() > 0.9999
        same = np.nonzero(hits.prim == found.prim)[0]
        np.testing.assert_allclose(hits.t[same], found.t[same], rtol=1e-5, atol=1e-5)
        assert (hits.t[hits.prim < 0] == (np.inf if limit is None else 1.5)).all()
    blocked = tree.occluded(o.astype(float), d.astype(float), limit)
    assert (blocked == (hits.prim >= 0)).mean() > 0.9999


def spawned(real, extent, offset, aspect, n, seed=1):
    """(rays, answers that are wrong) of n rays that leave 64 flat, sheared quads: of an extent, a place, and an aspect.

    Angles to the plane are log-uniform from 1e-8 on; as a quad is flat and alone, whatever is met is wrong.
    """
    rng = np.random.default_rng(seed)
    rays = wrong = 0
    for _ in range(64):
        turn = h.rotation(rng.integers(2**31))
        x, y = extent * turn[:, 0], extent / aspect * turn[:, 1]
        y = y + rng.uniform(-1, 1) * x * (aspect > 1)
        mesh = h.quad(rng.uniform(-1, 1, 3) * offset, x, y)
        tree, table, usable = tree_of(mesh.vertices.astype(np.float32), mesh.triangles, real)
        # Of the thinnest, far away, nothing is left; they are never met.
        count = n // 64 if usable.size else 0
        u, v = np.sort(rng.random((2, count)), axis=0)
        prim = rng.choice(usable, count)
        n_ = table.shape[9:].astype(float).take(prim, axis=1)
        cos, phi = 10.0 ** rng.uniform(-8, 0, count), rng.uniform(0, 2 * np.pi, count)
        along = np.cross(n_.T, rng.standard_normal(3)).T
        along /= np.linalg.norm(along, axis=0)
        d = cos * n_ + np.sqrt(1 - cos * cos) * (np.cos(phi) * along + np.sin(phi) * np.cross(n_.T, along.T).T)
        d *= rng.choice((-1.0, 1.0), count)
        hits = SimpleNamespace(prim=prim, u=u.astype(real), v=(v - u).astype(real), t=np.ones(count, real))
        surface = interact(table, flat_normals, (-d).astype(real), hits)
        d = d.astype(real)
        met = tree.closest(surface.o, d).prim >= 0
        blocked = tree.occluded(surface.o, d, np.full(count, np.inf, real))
        rays, wrong = rays + count, wrong + np.count_nonzero(met | blocked)
    return rays, wrong


CELLS = [(1.0, 0.0), (1.0, 1.0), (1e-6, 0.0), (1e-6, 1.0), (1e4, 0.0), (1e6, 1e6), (1e-2, 1.0)]
"""Extents and places: what rebasing leaves of any scene, and more."""


@pytest.mark.thorough
@pytest.mark.parametrize("aspect", [1, 10, 100, 1e4])
def test_rays_do_not_meet_what_they_leave(aspect):
    """A4: 0 of 1e6 rays in each cell of scale and place, also at slivers (of 13,000 where tests are quick).

    In between, where all triangles are just below `SLIVER`, shadows are left to Embree, which blocks 2 of 1e6.
    """
    for extent, offset in CELLS:
        rays, wrong = spawned(np.float64, extent, offset, aspect, 10**6 if SEED else 13_000)
        assert rays > 5_000
        assert wrong <= (2 if aspect == 10 else 0), (extent, offset)


@pytest.mark.parametrize("aspect", [1, 10])
def test_rays_do_not_meet_what_they_leave_in_single_precision(aspect):
    """The same of triangles of good shape; at slivers of aspect 1e4 it is 3 in 100."""
    assert [spawned(np.float32, *cell, aspect, 13_000)[1] for cell in CELLS] == [0] * len(CELLS)


def test_leaving_catches_hits_that_are_not_refused(monkeypatch):
    """The mutant believes Embree."""
    look = MeasuredAccel._look
    monkeypatch.setattr(MeasuredAccel, "_look", lambda *args: (look(*args)[0], np.zeros(0, np.intp), np.zeros((2, 3, 0))))
    assert spawned(np.float64, 1.0, 0.0, 1e4, 13_000)[1] > 100


def prism(aspect, sides=16, size=0.4):
    """A closed prism whose sides are slivers, generically turned."""
    angle = np.arange(sides) * 2 * np.pi / sides
    ring = np.stack((np.cos(angle), np.sin(angle), np.zeros(sides))) * size
    up = np.array([[0], [0], [1]])
    low, high = ring - up, ring + up
    width = 2 * size * np.sin(np.pi / sides)
    stretch = np.diag((1.0, 1.0, aspect * width))
    i, j = np.arange(sides), (np.arange(sides) + 1) % sides
    sides_of = np.concatenate((np.stack((i, j, j + sides)), np.stack((i, j + sides, i + sides))), axis=1)
    caps = np.concatenate((np.stack((0 * i, j, i))[:, 1:-1], np.stack((0 * i, i, j))[:, 1:-1] + sides), axis=1)
    vertices = h.rotation(5) @ stretch @ np.concatenate((low, high), axis=1)
    return h.Mesh(name="prism", vertices=vertices, triangles=np.concatenate((sides_of, caps), axis=1))


def grazing_inside(aspect, n, seed=3):
    """Rays o, d (3, n) float64 from near the axis of a `prism` along it, within 1e-3 of grazing its sides, and its tree."""
    rng = np.random.default_rng(seed)
    mesh = prism(aspect)
    tree, table, _ = tree_of(mesh.vertices.astype(np.float32), mesh.triangles)
    axis = h.rotation(5)[:, 2]
    length = np.abs(mesh.vertices.T @ axis).max()
    angle = 2 * np.pi * rng.random(n)
    across = h.rotation(5) @ np.stack((np.cos(angle), np.sin(angle), 0 * angle))
    o = across * 0.39 * rng.random(n) + axis[:, None] * length * rng.uniform(-1, 1, n)
    d = axis[:, None] + 10.0 ** rng.uniform(-7, -3, n) * h.directions(seed + 1, n)
    return tree, table, o, d / np.linalg.norm(d, axis=0)


@pytest.mark.parametrize(("aspect", "most_lost"), [(10, 0), (100, 0), (1e3, 3)])
def test_grazing_rays_do_not_leave_prisms_of_slivers(aspect, most_lost):
    """A8: none of 3e5 grazing rays leaves a closed prism whose sides are slivers, 3 at an aspect of 1e3, where Embree itself loses 2.

    Each ends where it leaves the convex prism in float64, to 64 eps in the direction of the side's normal.
    """
    tree, table, o, d = grazing_inside(aspect, 300_000)
    hits = tree.closest(o, d)
    assert np.count_nonzero(hits.prim < 0) <= most_lost
    v0, e1, e2, n = table.shape.reshape(4, 3, -1)
    slope = d.T @ n
    way = np.where(slope > 0, ((n * v0).sum(axis=0) - o.T @ n) / slope, np.inf)
    side = way.argmin(axis=1)
    leaves = way.min(axis=1)
    p = v0[:, hits.prim] + hits.u * e1[:, hits.prim] + hits.v * e2[:, hits.prim]
    off = np.abs(h.dots(p - o - leaves * d, n[:, side]))
    assert (off[hits.prim >= 0] <= 64 * EPS32 * (leaves + np.abs(p).max(axis=0))[hits.prim >= 0]).all()


def beside_a_sliver(aspect, n, seed=1):
    """The tree of a sliver, the first triangle, in a closed box; n rays within 1e-3 of its plane, and down to 1e-8; and how far (n,) they
    pass it by.
    """
    rng = np.random.default_rng(seed)
    x, y, normal = h.rotation(9).T
    corners = np.stack((-x / 2, x / 2, y / aspect + 0.37 * x), axis=1) + np.array([[0.1], [0.05], [-0.07]])
    vertices = np.concatenate((corners, h.box((-2, -2, -2), (2, 2, 2)).vertices), axis=1).astype(np.float32)
    tree, *_ = tree_of(vertices, np.concatenate((np.array([[0, 1, 2]]).T, 3 + h.BOX_TRIANGLES), axis=1))
    a, b = rng.uniform(-0.5, 1.5, (2, n))
    target = corners[:, :1] + a * (corners[:, 1:2] - corners[:, :1]) + b * (corners[:, 2:] - corners[:, :1])
    phi = rng.uniform(0, 2 * np.pi, n)
    along = np.cos(phi) * x[:, None] + np.sin(phi) * y[:, None]
    d = along + 10.0 ** rng.uniform(-8, -3, n) * rng.choice((-1.0, 1.0), n) * normal[:, None]
    d /= np.linalg.norm(d, axis=0)
    o = target - d * rng.uniform(0.1, 0.8, n)
    # Seen along the ray it is a point, and the sliver a flat triangle.
    seen = [way - h.dots(way, d) * d for way in (vertices[:, i : i + 1].astype(float) - o for i in range(3))]
    distance = np.full(n, np.inf)
    for p, q in zip(seen, (*seen[1:], seen[0])):
        share = np.clip(-h.dots(p, q - p) / h.dots(q - p, q - p), 0, 1)
        distance = np.minimum(distance, np.linalg.norm(p + share * (q - p), axis=0))
    turns = [h.dots(np.cross(p.T, q.T).T, d) for p, q in zip(seen, (*seen[1:], seen[0]))]
    inside = (np.array(turns) > 0).all(axis=0) | (np.array(turns) < 0).all(axis=0)
    return tree, o, d, np.where(inside, 0, distance)


@pytest.mark.parametrize("aspect", [100, 1e4])
def test_slivers_are_met_only_where_rays_pass_them(aspect):
    """A8: of 3e4 rays none meets the sliver that it passes by more than 4 eps, and none is lost; Embree alone meets hundreds so."""
    tree, o, d, distance = beside_a_sliver(aspect, 30_000)
    hits = tree.closest(o, d)
    assert (hits.prim >= 0).all()
    assert tree.lost.count == 0
    met = hits.prim == 0
    size = np.abs(o + hits.t * d).max(axis=0)
    assert np.count_nonzero(met) > 1000
    assert (distance[met] <= measured.BESIDE_ULPS * EPS32 * (hits.t + size + 1)[met]).all()
    found = tree.embree.closest(o.astype(np.float32), d.astype(np.float32))
    assert np.count_nonzero(distance[found.prim == 0] > 1000 * EPS32) > 100


def test_the_length_of_directions_changes_the_unit_of_distances_only():
    """As in the frames of moving objects that are stretched."""
    tree, o, d, _ = beside_a_sliver(1e4, 30_000)
    hits, long = tree.closest(o, d), tree.closest(o, 8 * d)
    assert (long.prim == hits.prim).mean() > 0.9995
    same = long.prim == hits.prim
    np.testing.assert_allclose(8 * long.t[same], hits.t[same], rtol=1e-9)


def test_a_shadow_is_cast_only_by_what_is_in_the_way():
    """Shadow rays are blocked where others meet something as near; Embree alone blocks hundreds more."""
    tree, o, d, _ = beside_a_sliver(1e4, 30_000)
    limit = np.full(o.shape[1], 1.5)
    blocked, hits = tree.occluded(o, d, limit), tree.closest(o, d, limit)
    assert (blocked == (hits.prim >= 0)).all()
    assert np.count_nonzero(tree.embree.occluded(o.astype(np.float32), d.astype(np.float32), limit.astype(np.float32)) & ~blocked) > 100


def test_rays_that_meet_wrong_triangles_only_are_counted_and_told(monkeypatch):
    """The mutant finds every hit wrong."""
    monkeypatch.setattr(measured, "_measured", lambda triangles, o, d: np.full((3, o.shape[1]), -1.0))
    monkeypatch.setattr(measured, "LIFT_ULPS", 0)
    settings = h.settings(width=4, height=4, samples=1, max_depth=0, precision="exact")
    scene = h.scene([h.thing(h.quad((0, 0, 0), (999, 0, 0), (0, 999, 0)))], world=1.0)
    image = render_image(scene, settings)
    (warning,) = image.warnings
    assert warning.startswith("16 rays met only triangles that double precision does not confirm, in 7 searches")
    assert (image.passes["Combined"][..., :3] == 1).all()


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_closed_meshes_hold_rays_in(monkeypatch, scale):
    """A6 as for Embree alone: what is refused at an edge is found beyond it."""
    monkeypatch.setattr(test_accel, "Accel", lambda vertices, triangles: tree_of(vertices, triangles)[0])
    test_accel.test_closed_meshes_hold_rays_in(scale)


def test_holding_in_catches_hits_that_are_not_searched_again(monkeypatch):
    """The mutant takes every refused hit for a miss."""
    monkeypatch.setattr(measured, "MOST_TRIES", 0)
    monkeypatch.setattr(measured, "BESIDE_ULPS", 0)
    with pytest.raises(AssertionError):
        test_closed_meshes_hold_rays_in(monkeypatch, 1.0)
