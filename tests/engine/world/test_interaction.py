"""Rays that leave a surface do not meet it again (catalogue A4, C11)."""

import numpy as np
import pytest

from glanz.engine.world import interaction
from glanz.engine.world.accel import Hits
from glanz.engine.world.interaction import flat_normals, interact
from glanz.tests import chance, helpers as h

DISTANCES = (1e-6, 1e-3, 0.3, 1.0, 30.0, 1e3, 1e6)
"""Of the camera, in sizes of the quad."""


def spawned(seed, distance, stretch=1.0, offset=(0, 0, 0), n=50_000):
    """The world of one random flat quad, and n rays that leave it with cosines log-uniform in [1e-8, 1]: o, d."""
    rng = np.random.default_rng(seed)
    turn = h.rotation(seed)
    offset = np.array(offset, float)
    eye = offset + turn @ (0.3, 0.2, 1.0) * distance
    camera = h.PerspectiveCamera.look_at(eye, offset, up=turn[:, 0])
    world = h.plan_of(
        h.scene([h.thing(h.quad(offset, turn[:, 0] * stretch, turn[:, 1] + 0.3 * turn[:, 0] * stretch))], camera=camera), h.settings()
    ).world
    u, v = rng.random((2, n), np.float32)
    outside = u + v > 1
    u[outside], v[outside] = 1 - u[outside], 1 - v[outside]
    prim = rng.integers(0, 2, n).astype(np.int32)
    surface = interact(world.triangles, flat_normals, h.directions(seed + 1, n, np.float32), Hits(prim, np.ones(n, np.float32), u, v))
    cos = 10.0 ** rng.uniform(-8, 0, n)
    across = np.cross(surface.n.T.astype(float), rng.standard_normal((n, 3))).T
    across /= np.linalg.norm(across, axis=0)
    d = (cos * surface.n + np.sqrt(1 - cos**2) * across).astype(np.float32)
    up = h.dots(surface.n, d) > 0
    return world, np.ascontiguousarray(surface.o[:, up]), np.ascontiguousarray(d[:, up])


def self_hits(**case):
    world, o, d = spawned(**case)
    return np.count_nonzero(world.accel.closest(o, d).prim >= 0)


@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("offset", [0.0, 1e7])
@chance.fresh
def test_rays_never_meet_the_surface_that_they_leave(distance, offset):
    """A4: 0 of 1.4e6 over distances from 1e-6 to 1e6 sizes, near the world's origin and 1e7 away from it."""
    assert sum(self_hits(seed=seed, distance=distance, offset=(offset, -2 * offset, offset)) for seed in range(2)) == 0


def test_never_catches_rays_that_start_on_the_surface(monkeypatch):
    """The mutant without an offset meets itself in about a third of all rays."""
    monkeypatch.setattr(interaction, "START_ULPS", 0)
    assert self_hits(seed=1, distance=1.0) > 1_000


def test_never_catches_an_offset_that_is_too_small(monkeypatch):
    monkeypatch.setattr(interaction, "START_ULPS", 0.5)
    assert self_hits(seed=1, distance=1e3) > 0


@pytest.mark.parametrize("aspect", [10.0, 100.0])
def test_slivers_hardly_ever_meet_themselves(aspect):
    """Embree's own test is at fault for slivers; of 1e5 rays 0 and 724 are measured, and with an aspect of 1000 5 in a hundred."""
    hits = sum(self_hits(seed=seed, distance=1.0, stretch=aspect, n=20_000) for seed in range(5))
    assert hits <= {10.0: 5, 100.0: 1_000}[aspect]


def test_normals_face_the_viewer_and_offsets_go_the_same_way():
    world = h.plan_of(h.scene([h.thing(h.icosphere(1))]), h.settings()).world
    n = 1_000
    rng = np.random.default_rng(2)
    d = h.directions(3, n, np.float32)
    prim = rng.integers(0, 80, n).astype(np.int32)
    surface = interact(world.triangles, flat_normals, d, Hits(prim, np.ones(n, np.float32), *np.full((2, n), 0.3, np.float32)))
    assert (h.dots(surface.n, d) <= 0).all()
    assert h.same_bits(surface.wo, -d)
    assert (h.dots(surface.o - surface.p, surface.n) > 0).all()
    assert h.same_bits(surface.n, surface.ns)


def test_smooth_normals_are_unit_and_follow_the_sphere():
    """A sphere of 1280 triangles: interpolated normals within 0.1 degrees of the sphere's, on the viewer's side."""
    mesh = h.icosphere(3, smooth=True)
    plan = h.plan_of(h.scene([h.thing(mesh)]), h.settings())
    world, n = plan.world, 5_000
    o = np.zeros((3, n), np.float32) + (-world.frame.origin * world.frame.scale).astype(np.float32)[:, None]
    d = h.directions(1, n, np.float32)
    hits = world.accel.closest(o, d)
    surface = interact(world.triangles, plan.shading_normals, d, hits)
    assert np.abs(h.dots(surface.ns, surface.ns) - 1).max() <= 1e-6
    centre = world.frame.points(np.zeros((3, 1)))
    truth = (surface.p - centre) / np.linalg.norm(surface.p - centre, axis=0)
    assert h.dots(-truth, surface.ns).min() >= np.cos(np.radians(0.1))


def test_flat_and_smooth_objects_share_a_world():
    """A smooth mesh beside a flat one: each keeps its own kind of normals."""
    smooth, flat = h.icosphere(2, smooth=True, centre=(-1.5, 0, 0), name="smooth"), h.icosphere(2, centre=(1.5, 0, 0), name="flat")
    plan = h.plan_of(h.scene([h.thing(flat), h.thing(smooth)]), h.settings())
    n = 2_000
    d = h.directions(1, n, np.float32)
    for x, is_flat in ((-1.5, False), (1.5, True)):
        o = np.repeat(plan.world.frame.points(np.array([[x], [0], [0]])), n, 1).astype(np.float32)
        surface = interact(plan.world.triangles, plan.shading_normals, d, plan.world.accel.closest(o, d))
        assert (surface.n == surface.ns).all() == is_flat
