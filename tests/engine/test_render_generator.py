"""`render` as a generator: progress, errors, cancelling (faults J3, J4, J19)."""

import gc
import re
import threading

import numpy as np
import pytest

from glanz.engine import GlanzError, PointLight, Requirements, SceneError, prepare, render, render_image, render_plan, rendering
from glanz.engine.integrators.path import Path
from glanz.engine.wavefront import branching, continuation, direct, passing, visibility
from glanz.engine.work import Work
from glanz.tests import helpers as h, scenes

SETTINGS = h.settings(width=24, height=20, samples=4, max_depth=2, tile_size=8, threads=2)


def glanz_threads():
    return [thread for thread in threading.enumerate() if thread.name.startswith("glanz")]


def final_tiles(items):
    return [tile for progress in items for tile in progress.tiles if tile.is_final]


def test_progress_rises_from_zero_to_one():
    items = list(render(scenes.everything(), SETTINGS))
    done = [progress.done for progress in items]
    assert done[0] == 0
    assert done[-1] == 1
    assert done == sorted(done)


def test_tiles_cover_the_frame_once():
    covered = np.zeros((20, 24), int)
    for tile in final_tiles(render(scenes.everything(), SETTINGS)):
        assert tile.width <= 8
        assert tile.height <= 8
        assert tile.passes["Combined"].shape == (tile.height, tile.width, 4)
        covered[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] += 1
    assert (covered == 1).all()


def test_tiles_of_a_border_stand_where_they_are_in_the_full_frame():
    tiles = final_tiles(render(scenes.everything(), h.replaced(SETTINGS, border=(5, 6, 20, 19))))
    assert min(tile.x for tile in tiles) == 5
    assert max(tile.y + tile.height for tile in tiles) == 19


def test_tiles_are_begun_from_the_middle_outwards(monkeypatch):
    begun = h.spy(monkeypatch, rendering, "_render_tile")
    list(render(scenes.everything(), h.replaced(SETTINGS, width=40, height=40, samples=1, threads=1)))
    places = [call.args[1][:2] for call in begun]
    assert places[0] == (16, 16)
    far = [max(abs(x - 16), abs(y - 16)) for x, y in places]
    assert far == sorted(far)


def test_the_image_tells_how_it_was_made():
    seen = []
    image = render_image(scenes.everything(), SETTINGS, seen.append)
    assert (image.width, image.height) == (24, 20)
    assert seen[-1].done == 1
    assert all(isinstance(value, str) for value in image.metadata.values())
    assert image.metadata["glanz.samples"] == "4"
    assert image.metadata["glanz.requirements"] == ", ".join(Requirements.of(scenes.everything(), SETTINGS).needs)


def test_closing_ends_all_threads(monkeypatch):
    """After a few tiles of many; the threads are gone when `close` returns."""
    generator = render(scenes.everything(), h.replaced(SETTINGS, width=64, height=64, samples=16, threads=4))
    for progress in generator:
        if progress.tiles:
            break
    assert glanz_threads()
    generator.close()
    assert not glanz_threads()


def test_an_abandoned_render_ends_its_threads_too():
    generator = render(scenes.everything(), h.replaced(SETTINGS, width=64, height=64, samples=16))
    while not next(generator).tiles:
        pass
    del generator
    gc.collect()
    assert not glanz_threads()


def test_closing_stops_within_a_bounce(monkeypatch):
    """No stage starts for more than one bounce of each thread once the generator is being closed."""
    started = threading.Event()
    after = []
    stop = threading.Event()
    travel = visibility.travel

    def slow(*args):
        started.set()
        if stop.is_set():
            after.append(threading.current_thread().name)
        return travel(*args)

    # At the beginning of every bounce, whatever rays pass on their way.
    monkeypatch.setattr(passing, "travel", slow)
    generator = render(scenes.everything(), h.replaced(SETTINGS, width=128, height=128, samples=64, max_depth=30, tile_size=0, threads=1))
    for _ in generator:
        if started.is_set():
            break
    stop.set()
    generator.close()
    assert len(after) <= 1 + 1
    assert not glanz_threads()


def test_finished_renders_leave_no_thread():
    render_image(scenes.everything(), SETTINGS)
    assert not glanz_threads()


@pytest.mark.parametrize("threads", [1, 4])
@pytest.mark.parametrize(
    "error", [ValueError("the moon is full"), MemoryError("no room"), SceneError("cup: broken"), KeyError("x")], ids=repr
)
def test_an_exception_in_a_worker_surfaces(monkeypatch, error, threads):
    """J3: the first error stops everything, is raised as it is, and leaves no thread."""
    calls = []

    def failing(plan, rays, surface, reflection, film):
        calls.append(rays)
        if len(calls) == 3:
            raise error

    monkeypatch.setattr(Path, "on_surface", (failing,))
    with pytest.raises(type(error)) as caught:
        list(render(scenes.everything(), h.replaced(SETTINGS, threads=threads)))
    assert caught.value is error
    assert not glanz_threads()


def test_an_exception_of_the_consumer_ends_all_threads():
    with pytest.raises(RuntimeError, match="enough"):
        render_image(scenes.everything(), h.replaced(SETTINGS, width=64, height=64), lambda progress: enough(progress))
    gc.collect()
    assert not glanz_threads()


def enough(progress):
    if progress.done > 0:
        raise RuntimeError("enough")


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_bad_samples_are_black_counted_and_told(monkeypatch, bad):
    """J19: one path in a hundred yields nonsense; the rest of its pixel stays."""
    heuristic = direct.power_heuristic

    def poisoned(pdf, other):
        weight = np.broadcast_to(heuristic(pdf, other), other.shape).copy()
        weight[::100] = bad
        return weight

    light = h.scene([h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)))], [scenes.everything().lights[0]])
    settings = h.replaced(SETTINGS, max_depth=0, threads=1, tile_size=0)
    clean = h.pixels(light, settings)
    monkeypatch.setattr(direct, "power_heuristic", poisoned)
    image = render_image(light, settings)
    values = np.moveaxis(image.passes["Combined"][..., :3], 2, 0)
    assert np.isfinite(values).all()
    changed = (values != clean).any(axis=0)
    assert 0 < changed.sum() <= 24 * 20 * 4 / 100 + 1
    assert (values[:, changed] < clean[:, changed]).all()
    first, in_all = image.warnings
    assert first.is_lost and first.datablock == ("object", "quad")
    x, y = (int(number) for number in re.search(r"pixel \((\d+), (\d+)\)", first).groups())
    assert changed[y, x]
    assert in_all == f"{changed.sum()} samples in all were not finite and count as black"


def overflowing():
    """A lamp at the limit of float32 that lights a near wall beyond it, and a far one within: those named so, left and right."""
    walls = [h.thing(h.quad((x, 0, z), (1, 0, 0), (0, 2, 0), name=name)) for name, x, z in (("near", -0.5, 0.0), ("far", 0.5, -30.0))]
    lamp = PointLight(name="lamp", position=(-0.5, 0, 0.1), intensity=(1e38,) * 3)
    return h.scene(walls, [lamp])


def test_who_made_a_sample_that_is_not_finite_is_named():
    """By its pixel and its object; what is sound next to it stays."""
    image = render_image(overflowing(), h.replaced(SETTINGS, max_depth=0))
    named = [warning for warning in image.warnings if warning.datablock[0]]
    assert [warning.datablock for warning in named] == [("object", "near")]
    values = image.passes["Combined"][..., :3]
    assert np.isfinite(values).all()
    assert (values > 0).any() and (values == 0).any()


@pytest.mark.parametrize("integrator", ["path", "path_blind", "path_naive", "distributed"])
def test_light_that_was_lost_on_the_way_is_told_of_where_it_was_lost(monkeypatch, integrator):
    """A path whose throughput is no number is black when it meets light, but it was the surface before that made it so."""
    leaving = continuation.leaving

    def poisoned(*where):
        scattered = leaving(*where)
        scattered.beta[:, ::7] = np.nan
        return scattered

    for module in (continuation, branching):
        monkeypatch.setattr(module, "leaving", poisoned)
    floor = h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0), name="floor"))
    ceiling = h.thing(h.quad((0, 0, 5), (90, 0, 0), (0, 90, 0), name="ceiling"), h.lambert(0.5, emission=1.0))
    image = render_image(h.scene([floor, ceiling]), h.replaced(SETTINGS, max_depth=1, integrator=integrator))
    assert {warning.datablock for warning in image.warnings if warning.is_lost} == {("object", "floor")}
    assert np.isfinite(image.passes["Combined"]).all()


def test_batches_are_together_as_long_as_they_take_little_time():
    """Half a second after it has begun a tile is to be seen, and a time limit noticed, however slow a scene is."""
    work = Work({(0, 0, 8, 8): None}, None, "relative")
    for seconds, together in ((0.01, 2), (0.01, 4), (0.01, 4), (0.2, 4), (0.3, 2), (0.3, 1), (9.0, 1), (0.1, 2)):
        work.pace(seconds, 0.25, 4)
        assert work.together == together, seconds


def test_errors_of_the_scene_come_with_the_first_item():
    with pytest.raises(GlanzError, match="has no camera"):
        next(render(h.replaced(h.scene(), camera=None), SETTINGS))
    assert not glanz_threads()


def test_two_renders_at_once_do_not_disturb_each_other():
    """Interleaved generators, bit for bit what each gives alone."""
    scene = scenes.everything()
    settings = [h.replaced(SETTINGS, seed=s) for s in (1, 2)]
    alone = [h.pixels(scene, s) for s in settings]
    images = [np.zeros((3, 20, 24), np.float32) for _ in settings]
    generators = [render(scene, s) for s in settings]
    while generators[0] or generators[1]:
        for i, generator in enumerate(generators):
            progress = next(generator, None) if generator else None
            if progress is None:
                generators[i] = None
                continue
            for tile in progress.tiles:
                images[i][:, tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = np.moveaxis(
                    tile.passes["Combined"][..., :3], 2, 0
                )
    assert h.same_bits(images[0], alone[0])
    assert h.same_bits(images[1], alone[1])


def test_the_consumer_is_woken_while_a_tile_takes_long(monkeypatch):
    """Between tiles there are items without any, so that cancelling can be asked for."""
    release = threading.Event()
    closest = visibility.interact

    def waiting(*args):
        release.wait(10)
        return closest(*args)

    monkeypatch.setattr(visibility, "interact", waiting)
    monkeypatch.setattr(rendering, "POLL_SECONDS", 0.01)
    generator = render(scenes.everything(), h.replaced(SETTINGS, tile_size=0))
    empty = [next(generator) for _ in range(5)]
    assert all(not progress.tiles for progress in empty)
    release.set()
    assert list(generator)[-1].done == 1


def test_the_tiles_that_threads_are_at_are_told(monkeypatch):
    """As many as there are threads, until they are let go; in the end none."""
    release = threading.Event()
    closest = visibility.interact
    monkeypatch.setattr(visibility, "interact", lambda *args: release.wait(10) and closest(*args))
    monkeypatch.setattr(rendering, "POLL_SECONDS", 0.01)
    generator = render(scenes.everything(), SETTINGS)
    at = next(progress.in_work for progress in generator if len(progress.in_work) == 2)
    assert all((x % 8, y % 8, width) == (0, 0, 8) for x, y, width, _ in at)
    release.set()
    rest = list(generator)
    assert all(len(progress.in_work) <= 2 for progress in rest)
    assert not rest[-1].in_work
    assert {tile.x for progress in rest for tile in progress.tiles} == {0, 8, 16}


def test_the_frame_refines_in_rounds_to_the_same_bits(monkeypatch):
    """After each round the whole frame has that many samples, and shows their mean; the last picture is that of one round."""
    monkeypatch.setattr(rendering, "SHOW_SECONDS", 600.0)
    plan, _ = prepare(scenes.everything(), h.replaced(SETTINGS, samples=7))
    rounds, image = [], np.zeros((20, 24, 4), np.float32)
    for progress in render_plan(plan, ends=(1, 3)):
        for tile in progress.tiles:
            image[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = tile.passes["Combined"]
            rounds.append(tile.is_final)
            if len(rounds) % 9 == 0:
                assert progress.done == pytest.approx((1 / 7, 3 / 7, 1)[len(rounds) // 9 - 1])
                part = h.replaced(plan.settings, sample_range=(0, (1, 3, 7)[len(rounds) // 9 - 1]))
                assert h.same_bits(np.moveaxis(image[..., :3], 2, 0), h.pixels(scenes.everything(), part))
    assert rounds == [False] * 18 + [True] * 9


def test_rounds_count_for_nothing_where_pixels_are_divided():
    plan, _ = prepare(scenes.everything(), h.replaced(SETTINGS, adaptive_threshold=0.1, samples=2, adaptive_levels=1))
    image = np.zeros((20, 24, 4), np.float32)
    for tile in final_tiles(render_plan(plan, ends=(1,))):
        image[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = tile.passes["Combined"]
    assert h.same_bits(np.moveaxis(image[..., :3], 2, 0), h.pixels_of_plan(plan))


def test_who_sets_the_event_ends_the_render():
    """No round is begun after it."""
    plan, _ = prepare(scenes.everything(), h.replaced(SETTINGS, width=64, height=64, samples=2**16))
    cancelled, after = threading.Event(), 0
    for progress in render_plan(plan, ends=range(1, 2**16), cancelled=cancelled):
        after += cancelled.is_set()
        if progress.tiles:
            cancelled.set()
    assert progress.done < 1
    assert after <= 8 * 8
    assert not glanz_threads()


def test_the_event_is_left_as_it_is():
    cancelled = threading.Event()
    plan, _ = prepare(scenes.everything(), SETTINGS)
    assert list(render_plan(plan, cancelled=cancelled))[-1].done == 1
    assert not cancelled.is_set()
