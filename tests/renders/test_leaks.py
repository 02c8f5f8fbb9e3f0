"""No light passes closed surfaces, and none is lost on the way to a light (catalogue A5, A9)."""

import math

import numpy as np
import pytest

from glanz.engine import PerspectiveCamera, PointLight
from glanz.engine.maths import patches
from glanz.engine.wavefront import direct, visibility
from glanz.engine.world import interaction
from glanz.engine.world.accel import Accel
from glanz.engine.world.measured import MeasuredAccel
from glanz.tests import chance, helpers as h

TREES = {"fast": Accel, "exact": MeasuredAccel}
"""Whom rays of each precision ask."""
CUBE = h.box((-1, -1, -1), (1, 1, 1), name="cube")


def star():
    """A closed, bumpy mesh around the origin."""
    mesh = h.icosphere(2)
    bump = 1 + 0.4 * np.random.default_rng(3).random(mesh.vertices.shape[1])
    return h.Mesh(name="star", vertices=h.rotation(5) @ (mesh.vertices * bump), triangles=mesh.triangles)


def escapes(mesh, monkeypatch, precision="fast", scale=1.0, offset=(0.0, 0.0, 0.0), paths=10_000, depth=100):
    """(rays that met nothing, rays traced) of random walks in a closed white mesh; no roulette ends any."""
    matrix = h.affine(scale * np.eye(3), offset)
    eye = np.array(offset) + scale * np.array((0.11, -0.07, 0.05))
    camera = PerspectiveCamera.look_at(eye, eye + scale * np.array((0.3, 0.5, 0.2)), fov=math.radians(100))
    calls = h.spy(monkeypatch, TREES[precision], "closest")
    side = math.isqrt(chance.times(paths))
    # The walk goes on because the world could be seen.
    h.pixels(
        h.scene([h.thing(mesh, h.lambert(1.0), matrix)], camera=camera, world=1.0),
        h.replaced(h.settings(width=side, height=side, max_depth=depth, precision=precision), samples=1),
    )
    traced = [call.result.prim for call in calls if call.result.prim.size > 1]
    monkeypatch.undo()
    return sum(np.count_nonzero(prim < 0) for prim in traced), sum(prim.size for prim in traced)


@pytest.mark.parametrize("precision", TREES)
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("name", ["cube", "star"])
@chance.fresh
def test_random_walks_stay_inside(monkeypatch, name, scale, precision):
    """A5: at most 5 of 1e6 segments escape, at every scale (3e-7 per segment are expected at corners)."""
    lost, segments = escapes({"cube": CUBE, "star": star()}[name], monkeypatch, precision, scale)
    assert segments > chance.times(0.95e6)
    assert lost <= (5 if segments < 2e6 else 15)


@pytest.mark.parametrize("precision", TREES)
@chance.fresh
def test_random_walks_stay_inside_far_from_the_origin(monkeypatch, precision):
    """A5 with an offset of 1e7 sizes, which float64 holds and rebasing takes away."""
    lost, segments = escapes(star(), monkeypatch, precision, offset=(1e7, -2e7, 1e7), depth=50)
    assert segments > chance.times(0.45e6)
    assert lost <= (4 if segments < 2e6 else 12)


@pytest.mark.parametrize("precision", TREES)
def test_random_walks_stay_inside_long_prisms(monkeypatch, precision):
    lost, segments = escapes(h.box((-1, -1, -100), (1, 1, 100)), monkeypatch, precision, depth=50)
    assert segments > 0.45e6
    assert lost <= 100  # corners are relatively closer: about 1e-4 at a distance of 100 sizes


def test_walks_catch_rays_that_start_on_the_surface(monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(interaction, "START_ULPS", 0)
        calls = h.spy(patch, Accel, "closest")
        camera = PerspectiveCamera.look_at((0.11, -0.07, 0.05), (0.4, 0.5, 0.2))
        h.pixels(
            h.scene([h.thing(star(), h.lambert(1.0))], camera=camera, world=1.0), h.settings(width=40, height=40, samples=1, max_depth=50)
        )
        lost = sum(np.count_nonzero(call.result.prim < 0) for call in calls if call.result.prim.size > 1)
    assert lost > 100


def test_walks_catch_an_offset_in_metres(monkeypatch):
    """The mutant lifts rays by 1e-5 m; in a mesh of a micrometre they all escape."""
    interact = visibility.interact
    scale = np.float32(2.0**20)  # of render space, where a micrometre is about 1

    def fixed(triangles, shading_normals, d, hits):
        surface = interact(triangles, shading_normals, d, hits)
        return h.replaced(surface, o=surface.p + np.float32(1e-5) * scale * surface.n)

    monkeypatch.setattr(visibility, "interact", fixed)
    lost, _ = escapes(CUBE, monkeypatch, scale=1e-6, paths=100)
    assert lost >= 90


def shadow_rays(monkeypatch, scene, settings):
    """(occluded, asked) over all shadow rays that matter."""
    calls = h.spy(monkeypatch, TREES[settings.precision], "occluded")
    image = h.pixels(scene, settings)
    # Rays without a length do not matter to anyone.
    asked = sum(np.count_nonzero(call.args[3] > 0) for call in calls)
    occluded = sum(np.count_nonzero(call.result & (call.args[3] > 0)) for call in calls)
    return occluded, asked, image


def lamp_over_floor(scale=1.0, offset=(0.0, 0.0, 0.0), height=1.0, turn=None):
    """Nothing but a floor and an emissive square; no shadow ray between them can be blocked."""
    turn = np.eye(3) if turn is None else turn
    matrix = h.affine(scale * turn, offset)
    floor = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0), name="floor"), h.lambert(0.5), matrix)
    lamp = h.thing(h.quad((0.1, 0.2, height), (0.7, 0, 0), (0, 0.5, 0), name="lamp"), h.lambert(0, "light", 1.0), matrix)
    eye, target = (matrix[:3, :3] @ np.array(p) + matrix[:3, 3] for p in ((0.5, -3, 2.0), (0.1, 0.2, 0)))
    return h.scene([floor, lamp], camera=PerspectiveCamera.look_at(eye, target))


CASES = {
    "plain": {},
    "turned": {"turn": h.rotation(1)},
    "tiny": {"scale": 1e-6, "turn": h.rotation(2)},
    "huge": {"scale": 1e6, "turn": h.rotation(3)},
    "far away": {"offset": (1e7, 1e7, -1e7), "turn": h.rotation(4)},
    **{f"{height:g} above the floor": {"height": height, "turn": h.rotation(5)} for height in (1e-3, 1e-4, 1e-5)},
}


@pytest.mark.parametrize("precision", TREES)
@pytest.mark.parametrize("name", CASES)
@chance.fresh
def test_the_lamp_does_not_stand_in_its_own_light(monkeypatch, name, precision):
    """A9: 0 of about 1e5 shadow rays to points on an emissive square are occluded, at each place and scale, down to 1e-5 of grazing."""
    settings = h.settings(width=128, height=128, samples=9, max_depth=0, precision=precision)
    occluded, asked, _ = shadow_rays(monkeypatch, lamp_over_floor(**CASES[name]), settings)
    assert asked > 50_000
    assert occluded == 0


def test_lamps_catch_shadow_rays_that_go_all_the_way(monkeypatch):
    """The mutant neither lifts points off the lamp nor shortens the ray."""
    monkeypatch.setattr(direct, "SHORTENED", np.float32(1))
    monkeypatch.setattr(patches, "END_ULPS", 0)
    occluded, asked, _ = shadow_rays(
        monkeypatch, lamp_over_floor(turn=h.rotation(1)), h.settings(width=32, height=32, samples=4, max_depth=0)
    )
    assert occluded > 0.1 * asked


@pytest.mark.parametrize("name", ["glass-thin", "coincident"])
def test_surfaces_that_touch_do_not_flicker_into_nothing(name):
    """A plate on a floor, and two floors in one place: lit, and nowhere black."""
    gap = {"glass-thin": 1e-4, "coincident": 0.0}[name]
    objects = [h.thing(h.quad((0, 0, z), (4, 0, 0), (0, 4, 0), name=f"{z}"), h.lambert(0.5)) for z in (0.0, gap)]
    image = h.pixels(h.scene(objects, [PointLight(position=(0, 0, 3))]), h.settings(width=32, height=32, samples=4, max_depth=0))
    plain = h.pixels(h.scene(objects[:1], [PointLight(position=(0, 0, 3))]), h.settings(width=32, height=32, samples=4, max_depth=0))
    lit = plain[0] > 0
    np.testing.assert_allclose(image[0][lit], plain[0][lit], rtol=0.05)
