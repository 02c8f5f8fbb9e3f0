"""Objects that move: met where they are at a ray's time, left without meeting themselves (catalogue A4), paid for by nobody else."""

import numpy as np
import pytest

from glanz.engine.arrays import Columns
from glanz.engine.maths.poses import Keys
from glanz.engine.wavefront import motion
from glanz.engine.wavefront.records import Rays
from glanz.engine.world import movers as module
from glanz.engine.world.accel import Accel, Hits
from glanz.tests import helpers as h

DISTANCES = (1e-6, 1e-3, 0.3, 1.0, 30.0, 1e3, 1e6)
"""Of the camera, in sizes of the quad."""
SPIN = np.stack([h.affine(h.rotation(7), (0.3, -0.2, 0.1)), h.affine(h.rotation(8), (-0.4, 0.5, 0.2)), h.affine(h.rotation(9))])


def batch(d, time, o=None):
    """Rays along d (3, N) at `time` (N,)."""
    n = time.size
    carried = Columns(time=time.astype(np.float32))
    index = np.arange(n, dtype=np.uint32)
    o = np.zeros((3, n), np.float32) if o is None else o
    return Rays(o, d, np.ones((3, n), np.float32), np.zeros(0, np.float32), index, index, index, 0, carried=carried)


def spawned(seed, distance, keys, size=1.0, offset=(0, 0, 0), n=50_000):
    """A moving quad, and n rays at random times that leave it with cosines log-uniform in [1e-8, 1]: plan, time, o, d."""
    rng = np.random.default_rng(seed)
    offset = np.array(offset, float)
    keys = np.array(keys)
    keys[:, :3, 3] = offset + size * keys[:, :3, 3]
    keys[:, :3, :3] *= size
    camera = h.PerspectiveCamera.look_at(offset + size * distance * np.array((0.3, 0.2, 1.0)), offset)
    turn = h.rotation(seed)
    quad = h.quad((0.1, 0.2, 0.3), turn[:, 0], turn[:, 1] + 0.3 * turn[:, 0])
    plan = h.plan_of(h.scene([h.replaced(h.thing(quad), motion=keys)], camera=camera), h.settings())
    u, v = rng.random((2, n), np.float32)
    outside = u + v > 1
    u[outside], v[outside] = 1 - u[outside], 1 - v[outside]
    rays = batch(h.directions(seed + 1, n, np.float32), rng.random(n, np.float32))
    hits = Hits(rng.integers(0, 2, n).astype(np.int32), np.ones(n, np.float32), u, v)
    surface = plan.interact(plan, rays, hits)
    cos = 10.0 ** rng.uniform(-8, 0, n)
    across = np.cross(surface.n.T.astype(float), rng.standard_normal((n, 3))).T
    across /= np.linalg.norm(across, axis=0)
    d = (cos * surface.n + np.sqrt(1 - cos**2) * across).astype(np.float32)
    up = h.dots(surface.n, d) > 0
    return plan, rays.carried.time[up], np.ascontiguousarray(surface.o[:, up]), np.ascontiguousarray(d[:, up])


def self_hits(**case):
    plan, time, o, d = spawned(**case)
    hits = plan.closest(plan, Columns(time=time), o, d)
    blocked = plan.occluded(plan, Columns(time=time), o, d, np.full(time.size, np.inf, np.float32))
    assert ((hits.prim >= 0) == blocked).all()
    return np.count_nonzero(blocked)


@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_rays_never_meet_the_moving_surface_that_they_leave(distance, size):
    """A4: 0 of 1e6 over distances of the camera from 1e-6 to 1e6 sizes, and sizes from 1e-6 to 1e6 m."""
    assert sum(self_hits(seed=seed, distance=distance, keys=SPIN, size=size, n=25_000) for seed in range(2)) == 0


@pytest.mark.parametrize("distance", DISTANCES)
def test_rays_never_meet_a_surface_that_is_stretched_while_it_moves(distance):
    keys = np.array(SPIN)
    keys[0, :3, :3] *= (1, 0.1, 3)
    keys[2, :3, :3] = keys[2, :3, :3] @ [[1, 0.5, 0], [0, 1, 0], [0, 0.2, 4]]
    assert sum(self_hits(seed=seed, distance=distance, keys=keys) for seed in range(2)) == 0


def test_rays_never_meet_a_moving_surface_far_from_the_origin():
    assert self_hits(seed=3, distance=1.0, keys=SPIN, offset=(1e7, -2e7, 1e7)) == 0


@pytest.mark.parametrize("ulps", [0, 0.25])
def test_never_catches_rays_that_start_too_low(monkeypatch, ulps):
    monkeypatch.setattr(motion, "START_ULPS", ulps)
    assert self_hits(seed=1, distance=1.0, keys=SPIN) > 10


def test_a_surface_is_where_and_how_it_would_be_if_it_stood_there():
    """Points, normals and sides of a stretched, spinning, mirrored sphere, at each of some times, against still copies."""
    mesh = h.icosphere(2, 0.5, smooth=True)
    stretch = np.diag([1, 1.5, -0.7])
    keys = np.stack([h.affine(h.rotation(1) @ stretch), h.affine(h.rotation(2) @ stretch, (0.5, 0.2, -0.1))])
    o = h.replaced(h.thing(mesh), motion=keys)
    plan = h.plan_of(h.scene([o]), h.settings())
    n = 4_000
    for time in (0.0, 0.2, 0.75):
        still = h.plan_of(h.scene([h.thing(mesh, matrix=Keys.of(keys).matrix(time))]), h.settings())
        target = np.random.default_rng(1).uniform(-0.5, 0.7, (3, n)) - plan.world.frame.origin[:, None]
        d = (target / np.linalg.norm(target, axis=0)).astype(np.float32)
        surfaces = []
        for p in (plan, still):
            rays = batch(d, np.full(n, time))
            hits = p.closest(p, rays.carried, rays.o, rays.d)
            lanes = np.nonzero(hits.prim >= 0)[0]
            assert lanes.size > n / 10
            surfaces.append((lanes, p.interact(p, rays.landed(lanes), hits.take(lanes)), p.world.frame.scale))
        (a_lanes, a, a_scale), (b_lanes, b, b_scale) = surfaces
        assert np.setxor1d(a_lanes, b_lanes).size <= 5
        both = np.intersect1d(a_lanes, b_lanes)
        i, j = np.searchsorted(a_lanes, both), np.searchsorted(b_lanes, both)
        assert np.quantile(np.abs(a.p[:, i] / a_scale - b.p[:, j] / b_scale), 0.999) <= 1e-5
        assert np.quantile(np.abs(a.n[:, i] - b.n[:, j]), 0.99) <= 1e-5
        assert np.quantile(np.abs(a.ns[:, i] - b.ns[:, j]), 0.99) <= 1e-4
        assert (a.is_front[i] == b.is_front[j]).mean() > 0.999
        assert (h.dots(a.n, d[:, a_lanes]) <= 1e-6).all()


def stopped(o, time):
    """The object `o` as it stands at `time`."""
    return h.replaced(o, motion=np.zeros((0, 4, 4)), world_from_object=Keys.of(o.motion).matrix(time)) if o.moves else o


def test_the_nearest_of_all_is_met():
    """Against a world in which everything stands where it is at one time."""
    rng = np.random.default_rng(5)
    objects = []
    for i in range(6):
        path = [h.affine(h.rotation(20 + i), rng.uniform(-1, 1, 3)), h.affine(h.rotation(40 + i), rng.uniform(-1, 1, 3))]
        thing = h.thing(h.box((-0.3, -0.3, -0.3), (0.3, 0.3, 0.3), name=f"{i}"))
        objects.append(h.replaced(thing, motion=np.stack(path)) if i < 4 else h.replaced(thing, world_from_object=path[0]))
    scene = h.scene(objects)
    plan = h.plan_of(scene, h.settings())
    n = 5_000
    everywhere = np.full(n, np.inf, np.float32)
    target = rng.uniform(-1.2, 1.2, (3, n)) - plan.world.frame.origin[:, None]
    d = (target / np.linalg.norm(target, axis=0)).astype(np.float32)
    o = np.zeros_like(d)
    for time in (0.1, 0.5, 0.9):
        carried = Columns(time=np.full(n, time, np.float32))
        hits = plan.closest(plan, carried, o, d)
        still = h.plan_of(h.scene([stopped(o, time) for o in objects]), h.settings())
        truth = still.closest(still, Columns(), o, d)
        both = np.isfinite(hits.t) & np.isfinite(truth.t)
        assert both.sum() > n / 10
        assert (np.isfinite(hits.t) != np.isfinite(truth.t)).sum() <= 5
        a, b = hits.t[both] / plan.world.frame.scale, truth.t[both] / still.world.frame.scale
        assert (np.abs(a - b) > 1e-4).sum() <= 5
        assert np.count_nonzero(plan.occluded(plan, carried, o, d, np.float32(0.999) * truth.t)) <= np.count_nonzero(~both) + 5
        assert (plan.occluded(plan, carried, o, d, everywhere) == np.isfinite(hits.t)).all()


def test_rays_that_pass_far_from_a_moving_object_never_reach_its_tree(monkeypatch):
    ball = h.replaced(h.thing(h.icosphere(1, 0.5)), motion=np.stack([h.affine(translation=(x, 0, 0)) for x in (-5, 5)]))
    plan = h.plan_of(h.scene([ball]), h.settings())
    d = h.directions(1, 10_000, np.float32)
    time = np.random.default_rng(2).random(10_000, np.float32)
    calls = h.spy(monkeypatch, Accel, "closest")
    hits = plan.closest(plan, Columns(time=time), np.zeros_like(d), d)
    asked = sum(call.args[1].shape[1] for call in calls if call.args[0] is not plan.world.accel)
    met = np.count_nonzero(hits.prim >= 0)
    assert 0 < met <= asked <= 2 * met
    # And none that meets it is left out.
    monkeypatch.setattr(module, "_passes", lambda away, d, radius, limit: np.arange(d.shape[1]))
    assert h.same_bits(plan.closest(plan, Columns(time=time), np.zeros_like(d), d).prim, hits.prim)


def swarm(count, seed=3):
    """Small boxes that fly about, all over the place."""
    places = np.random.default_rng(seed).uniform(-2, 2, (count, 2, 3))
    box = h.thing(h.box((-0.2, -0.2, -0.2), (0.2, 0.2, 0.2)))
    keys = [[h.affine(h.rotation(2 * i + j), place) for j, place in enumerate(pair)] for i, pair in enumerate(places)]
    return [h.replaced(box, motion=np.stack(pair)) for pair in keys]


def test_many_objects_are_found_as_if_each_were_asked_for(monkeypatch):
    """A tree of spheres around 60 leaves out most of them for most rays, and none that is met."""
    plan = h.plan_of(h.scene(swarm(60)), h.settings())
    n = 4_000
    d, time = h.directions(1, n, np.float32), np.random.default_rng(2).random(n, np.float32)
    o = np.repeat(plan.world.frame.points(np.zeros((3, 1))), n, axis=1).astype(np.float32)
    carried, limit = Columns(time=time), np.full(n, 0.2, np.float32)
    found, blocked = plan.closest(plan, carried, o, d), plan.occluded(plan, carried, o, d, limit)
    monkeypatch.setattr(module, "_passes", lambda away, d, radius, limit: np.arange(d.shape[1]))
    assert h.same_bits(plan.closest(plan, carried, o, d).prim, found.prim)
    assert h.same_bits(plan.occluded(plan, carried, o, d, limit), blocked)
    assert 0.1 < blocked.mean() < (found.prim >= 0).mean() < 0.9


def test_a_vertex_that_is_nowhere_hides_nothing():
    """A mesh with a vertex that is not finite loses the triangle that uses it, and no other."""
    mesh = h.icosphere(1)
    vertices = mesh.vertices.astype(np.float64)
    vertices[:, 0] = np.nan
    ball = h.replaced(h.thing(h.replaced(mesh, vertices=vertices)), motion=SPIN)
    plan = h.plan_of(h.scene([ball]), h.settings())
    assert plan.world.warnings
    hits = plan.closest(plan, Columns(time=np.zeros(500, np.float32)), np.zeros((3, 500), np.float32), h.directions(1, 500, np.float32))
    assert (hits.prim >= 0).any()
