"""The session behind a rendered 3D view: what it shows, what it does again, and that it ends."""

import threading
import time

import numpy as np
import pytest

from glanz.addon import viewport
from glanz.addon.viewport import ENDLESS, Session, enlarged, progress_text
from glanz.engine import PerspectiveCamera, Settings
from glanz.tests import helpers as h, scenes

SETTINGS = Settings(width=40, height=32, samples=6, max_depth=1, tile_size=16, threads=2, pixel_filter="box")
SCENE = scenes.everything()
PATIENCE = 30.0


class At:
    """A view from x."""

    def __init__(self, x=3.0):
        self.x = x

    def __eq__(self, other):
        return isinstance(other, At) and self.x == other.x

    def camera(self):
        return PerspectiveCamera.look_at((self.x, -4, 2.5), (0, 0, 0.5), fov=0.6)


@pytest.fixture
def session():
    session = Session()
    yield session
    session.close()
    until(lambda: not any(thread.name.startswith("glanz") for thread in threading.enumerate()))


def until(condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.002)


def finished(session):
    until(lambda: not session.is_busy)
    return session.picture.pixels


def fresh(view, scene=SCENE, settings=SETTINGS):
    """What a render of its own shows, as pictures have it."""
    return np.moveaxis(h.pixels(h.replaced(scene, camera=view.camera()), settings), 0, 2)[::-1]


def assert_same(pixels, expected):
    """But for rounding, which at edges decides what is seen."""
    assert pixels.shape[:2] == expected.shape[:2]
    assert np.isclose(pixels[..., :3], expected, rtol=1e-3, atol=1e-5).all(axis=2).mean() > 0.97


def counted(monkeypatch):
    """The calls of `prepare`."""
    return h.spy(monkeypatch, viewport, "prepare")


def test_the_picture_becomes_that_of_a_render(session):
    session.show(SCENE)
    session.look(At(), SETTINGS)
    assert session.is_busy
    assert_same(finished(session), fresh(At()))
    assert session.status == "6 samples"


def test_one_sample_is_told_of_as_many_are(session):
    session.show(SCENE)
    session.look(At(), h.replaced(SETTINGS, samples=1))
    finished(session)
    assert session.status == "1 sample"


def test_another_view_and_another_size_compile_nothing(session, monkeypatch):
    calls = counted(monkeypatch)
    session.show(SCENE)
    for view, settings in ((At(3), SETTINGS), (At(-2), SETTINGS), (At(-2), h.replaced(SETTINGS, width=24, samples=3))):
        session.look(view, settings)
        assert_same(finished(session), fresh(view, settings=settings))
    assert len(calls) == 1


def test_other_scenes_and_settings_are_compiled_and_keep_the_tree(session, monkeypatch):
    calls = counted(monkeypatch)
    session.show(SCENE)
    session.look(At(), SETTINGS)
    finished(session)
    accel = session._plan.world.accel
    dark = h.replaced(SCENE, lights=())
    session.show(dark)
    assert_same(finished(session), fresh(At(), dark))
    deeper = h.replaced(SETTINGS, max_depth=3)
    session.look(At(), deeper)
    assert_same(finished(session), fresh(At(), dark, deeper))
    exact = h.replaced(deeper, precision="exact")
    session.look(At(), exact)
    assert_same(finished(session), fresh(At(), dark, exact))
    assert len(calls) == 4
    assert session._plan.world.accel.embree is accel


def test_what_asks_for_a_render_space_of_its_own_gets_it(session):
    """A millimetre of a plane, 1000 m away from where the first view was."""

    class Near(At):
        def camera(self):
            return PerspectiveCamera.look_at((self.x, 0, 1e-3), (self.x, 1e-4, 0))

    plane = h.scene([h.thing(h.quad((0, 0, 0), (4000, 0, 0), (0, 4000, 0)))], SCENE.lights)
    session.show(plane)
    session.look(At(0), SETTINGS)
    finished(session)
    session.look(Near(1000), SETTINGS)
    assert_same(finished(session), fresh(Near(1000), plane))
    assert not session._plan.place.any()


def test_whoever_looks_at_the_same_waits_for_nothing(session):
    session.show(SCENE)
    session.look(At(), SETTINGS)
    pixels = finished(session)
    session.look(At(), h.replaced(SETTINGS))
    assert not session.is_busy
    assert session.picture.pixels is pixels


def test_it_rests_when_all_is_done(session, monkeypatch):
    """Its thread waits, and takes no time of the processor."""
    session.show(SCENE)
    session.look(At(), SETTINGS)
    finished(session)
    before = time.process_time()
    time.sleep(0.3)
    assert time.process_time() - before < 0.1


def test_there_is_a_picture_of_every_view_that_waits_for_it_whatever_comes_next(session):
    """The first, coarse picture is not given up: a view that never stops turning is seen all the same."""
    session.show(SCENE)
    seen = []
    settings = h.replaced(SETTINGS, width=320, height=256, samples=ENDLESS)
    for i in range(200):
        session.look(At(3 - 0.02 * i), settings)
        time.sleep(0.01)
        if session.picture not in (None, *seen):
            seen.append(session.picture)
            if len(seen) > 3:
                return
    pytest.fail(f"{len(seen)} pictures")


def test_coarse_pictures_come_first_and_are_left_for_what_is_wished_next(session, monkeypatch):
    refined = h.spy(monkeypatch, Session, "_refine")
    session.show(SCENE)
    session.look(At(), h.replaced(SETTINGS, samples=ENDLESS))
    until(lambda: session.status.startswith("Sample"))
    session.look(At(-2), SETTINGS)
    assert_same(finished(session), fresh(At(-2)))
    coarse = [call.args[2] for call in refined]
    assert coarse[:3] == [16, 4, 1]
    assert coarse[3] > 1
    assert coarse[-1] == 1


@pytest.mark.parametrize(
    ("before", "seconds", "levels"),
    [(5, 0.0, [(16, 2)] * 3), (3, 0.0, [(8, ENDLESS), (16, ENDLESS), (16, 2)]), (5, 1e9, [(16, 2), (16, ENDLESS), (8, ENDLESS)])],
)
def test_first_pictures_become_as_coarse_as_their_time_asks_for(session, monkeypatch, before, seconds, levels):
    """They take too long, or hardly any of what they may; nobody knows of the very first."""
    assert session._first == 5
    session._first = before
    monkeypatch.setattr(viewport, "FIRST_SECONDS", seconds)
    refined = h.spy(monkeypatch, Session, "_refine")
    session.show(SCENE)
    for x in range(3):
        session.look(At(x), SETTINGS)
        finished(session)
    assert [(call.args[2], call.args[6]) for call in refined if call.args[4] is None] == levels


@pytest.mark.parametrize(("asked", "traced"), [(1, 1), (3, 2)])
def test_the_very_first_picture_has_few_bounces_and_the_others_what_is_asked_for(session, monkeypatch, asked, traced):
    rendered = h.spy(monkeypatch, viewport, "render_plan")
    session.show(SCENE)
    session.look(At(), h.replaced(SETTINGS, max_depth=asked))
    finished(session)
    assert [call.args[0].settings.max_depth for call in rendered] == [traced, asked, asked]


def test_no_samples_without_end(session):
    session.show(SCENE)
    session.look(At(), h.replaced(SETTINGS, samples=ENDLESS))
    until(lambda: session.status.startswith("Sample 3"))
    assert session.is_busy
    session.close()
    assert not session.is_busy


def test_errors_are_told_and_gone_with_their_cause(session, capsys):
    class Nowhere(At):
        def camera(self):
            return h.replaced(At().camera(), clip_start=-1.0)

    session.show(SCENE)
    session.look(Nowhere(), SETTINGS)
    until(lambda: not session.is_busy)
    assert "clip range is -1" in session.status
    assert capsys.readouterr().err == ""
    session.look(At(2), SETTINGS)
    assert_same(finished(session), fresh(At(2)))
    assert session.status == "6 samples"


def test_faults_are_told_with_their_traceback(session, monkeypatch, capsys):
    def broken(*args, **kwargs):
        raise ValueError("the moon is full")

    monkeypatch.setattr(viewport, "prepare", broken)
    session.show(SCENE)
    session.look(At(), SETTINGS)
    until(lambda: not session.is_busy)
    assert session.status == "Glanz failed: ValueError: the moon is full"
    assert "Traceback" in capsys.readouterr().err


@pytest.mark.parametrize("nothing", ["scene", "view"])
def test_without_a_scene_or_a_view_there_is_nothing_to_do(session, nothing):
    session.show(SCENE)
    session.look(At(), h.replaced(SETTINGS, samples=ENDLESS))
    until(lambda: session.picture)
    if nothing == "scene":
        session.show(None)
    else:
        session.look(None, None)
    until(lambda: not session.is_busy)


def test_closed_it_stays_closed(session):
    session.show(SCENE)
    session.look(At(), h.replaced(SETTINGS, samples=ENDLESS))
    until(lambda: session.picture)
    session.close()
    session.look(At(1), SETTINGS)
    assert session.is_closed
    assert not session.is_busy


def test_enlarged_pixels_are_where_they_were():
    pixels = np.arange(6, dtype=np.float32).reshape(2, 3, 1)
    assert enlarged(pixels, 6, 4)[..., 0].tolist() == [[0, 0, 1, 1, 2, 2]] * 2 + [[3, 3, 4, 4, 5, 5]] * 2
    assert enlarged(pixels, 5, 3).shape == (3, 5, 1)


def test_progress_in_words():
    assert progress_text(0.0, 32) == "Sample 1 of 32"
    assert progress_text(0.5, 32) == "Sample 17 of 32"
    assert progress_text(1.0, 32) == "32 samples"
    assert progress_text(2 / ENDLESS, ENDLESS) == "Sample 3"
