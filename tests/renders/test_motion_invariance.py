"""Pictures of what moves depend on nothing that they should not, and nothing that stands still pays."""

import numpy as np
import pytest

from glanz.engine import rendering
from glanz.engine.dimensions import Dimension
from glanz.engine.wavefront.numbers import Numbers
from glanz.engine.world.accel import Accel
from glanz.tests import helpers as h, scenes
from glanz.tests.moving import moving, shifted, turned

EVERYTHING = h.settings(width=24, height=16, samples=4, max_depth=3, threads=2, passes=("Combined", "Depth", "Normal"))


def busy():
    """The scene of all features, with a spinning sphere, a sliding box that shrinks, a mesh that deforms, and a moving camera."""
    base = scenes.everything()
    by_name = {o.name: o for o in base.objects}
    shapes = np.stack([by_name["flat"].mesh.vertices * [[1.0], [1.0], [z]] for z in (0.6, 1.4)])
    by_name["smooth"] = moving(by_name["smooth"], turned((-0.6, 0.9, 1.2), (-1, 0.25, 0)))
    by_name["box"] = moving(by_name["box"], np.stack([h.affine(s * np.eye(3), (s, 0, 0)) for s in (1.0, 0.5)]))
    by_name["flat"] = h.replaced(by_name["flat"], mesh=h.replaced(by_name["flat"].mesh, shapes=shapes))
    by_name["glow"] = moving(by_name["glow"], shifted((0, 0, 0), (0, 0.2, 0.1)))
    view = base.camera.world_from_camera
    camera = h.replaced(base.camera, motion=shifted((-0.1, 0, 0), (0.1, 0.05, 0)) @ view)
    return h.replaced(base, objects=tuple(by_name.values()), camera=camera)


def all_passes(settings, scene):
    passes = rendering.render_image(scene, settings).passes
    return np.concatenate([passes[name] for name in sorted(passes)], axis=2)


@pytest.fixture(scope="module")
def busy_picture():
    return all_passes(EVERYTHING, busy())


@pytest.mark.parametrize(("threads", "tile_size"), [(1, 16), (2, 64), (5, 0), (2, 5), (2, 1)])
def test_threads_and_tiles_change_no_bit_of_what_moves(busy_picture, threads, tile_size):
    assert h.same_bits(all_passes(h.replaced(EVERYTHING, threads=threads, tile_size=tile_size), busy()), busy_picture)


@pytest.mark.parametrize("lanes", [7, 384, 10**6])
def test_batches_change_no_bit_of_what_moves(busy_picture, monkeypatch, lanes):
    monkeypatch.setattr(rendering, "LANES", lanes)
    assert h.same_bits(all_passes(EVERYTHING, busy()), busy_picture)


@pytest.mark.parametrize("border", [(3, 5, 17, 9), (0, 0, 1, 1)], ids=str)
def test_a_border_renders_the_same_pixels_of_what_moves(busy_picture, border):
    x0, y0, x1, y1 = border
    assert h.same_bits(all_passes(h.replaced(EVERYTHING, border=border), busy()), busy_picture[y0:y1, x0:x1])


@pytest.mark.parametrize("k", [-40, 20])
def test_a_power_of_two_as_scale_changes_no_bit_of_what_moves(k):
    def image(s):
        keys = turned((0.0, 0.5), (s, 0, 0))
        objects = [moving(o, keys) if o.name == "smooth" else o for o in scenes.everything(scale=s).objects]
        return h.pixels(h.replaced(scenes.everything(scale=s), objects=objects), h.replaced(EVERYTHING, passes=("Combined",)))

    assert h.same_bits(image(2.0**k), image(1.0))


def asked(monkeypatch, scene):
    """How many numbers for times, and calls to Embree, a picture takes."""
    with monkeypatch.context() as patch:
        numbers = h.spy(patch, Numbers, "one")
        closest, occluded = h.spy(patch, Accel, "closest"), h.spy(patch, Accel, "occluded")
        plan = h.plan_of(scene, EVERYTHING)
        built = len(closest)
        h.pixels_of_plan(h.replaced(plan, settings=h.replaced(EVERYTHING, threads=1, tile_size=0)))
    times = sum(call.args[2] == Dimension.TIME for call in numbers)
    return times, len(closest) - built, len(occluded), plan


def test_what_stands_still_pays_nothing(monkeypatch):
    """No number, no column, no more calls. Keys that are all the same are no motion; one mover adds a call for each batch of rays."""
    base = scenes.everything()
    times, closest, occluded, plan = asked(monkeypatch, base)
    assert times == 0
    assert (plan.carry, plan.camera_poses, plan.world.movers) == ((), None, None)
    same = h.replaced(base, objects=[moving(o, shifted((0, 0, 0), (0, 0, 0))) for o in base.objects])
    assert asked(monkeypatch, same)[:3] == (0, closest, occluded)
    ball = [moving(o, shifted((0, 0, 0), (0.1, 0, 0))) if o.name == "smooth" else o for o in base.objects]
    moved = asked(monkeypatch, h.replaced(base, objects=ball))
    assert moved[0] == 1
    assert closest < moved[1] <= 2 * closest
    assert occluded < moved[2] <= 2 * occluded
    camera = h.replaced(base.camera, motion=shifted((0, 0, 0), (0.1, 0, 0)) @ base.camera.world_from_camera)
    times, _, _, plan = asked(monkeypatch, h.replaced(base, camera=camera))
    assert times == 1
    assert plan.world.movers is None


def test_a_still_part_of_a_moving_scene_keeps_its_own_bits():
    """What does not see what moves is as if nothing did."""
    base = scenes.everything()
    settings = h.settings(width=24, height=16, samples=4, max_depth=0, passes=("Depth",))
    away = moving(h.thing(h.box((50, 50, 50), (51, 51, 51), name="away")), shifted((0, 0, 0), (1, 0, 0)))
    a = rendering.render_image(base, settings).passes["Depth"]
    b = rendering.render_image(h.replaced(base, objects=(*base.objects, away)), settings).passes["Depth"]
    np.testing.assert_allclose(a, b, rtol=1e-6)
