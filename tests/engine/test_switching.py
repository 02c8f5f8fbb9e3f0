"""The interval at which threads take turns is a render's own for as long as it lasts, and the process' again after it."""

import sys
import threading

import pytest

from glanz.engine import Settings, rendering, switching
from glanz.engine.switching import SECONDS, brisk_switching
from glanz.tests import helpers as h

SCENE = h.scene([h.thing(h.quad(), h.lambert(0.5, emission=1.0))])


@pytest.fixture(autouse=True)
def usual():
    """The interval of the process, which comes back after each test."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(0.004)
    yield
    sys.setswitchinterval(before)


def test_threads_take_turns_sooner_while_there_is_a_render_and_as_before_when_it_is_over():
    seen = [sys.getswitchinterval() for _ in rendering.render(SCENE, Settings(width=8, height=8, samples=1, threads=2))]
    assert seen[-1] == pytest.approx(SECONDS)
    assert sys.getswitchinterval() == pytest.approx(0.004)


def test_a_render_that_is_given_up_leaves_the_interval_as_it_was():
    steps = rendering.render(SCENE, Settings(width=8, height=8, samples=64, threads=2))
    while sys.getswitchinterval() > SECONDS * 1.01:
        next(steps)
    steps.close()
    assert sys.getswitchinterval() == pytest.approx(0.004)


def test_of_renders_that_overlap_the_last_to_end_brings_the_interval_back():
    """In whatever order they end: the first to begin is the first to end here, as a viewport that is left while a picture is rendered."""
    first, second = brisk_switching(), brisk_switching()
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    assert sys.getswitchinterval() == pytest.approx(SECONDS)
    second.__exit__(None, None, None)
    assert sys.getswitchinterval() == pytest.approx(0.004)


def test_a_render_that_ends_while_the_same_thread_begins_another_does_not_wait_for_itself():
    """As one that was left does when it is collected."""
    render = brisk_switching()
    render.__enter__()
    ended = threading.Event()

    def begin():
        with switching._lock:
            render.__exit__(None, None, None)
        ended.set()

    threading.Thread(target=begin, daemon=True).start()
    assert ended.wait(10)


def test_a_shorter_interval_of_the_process_stays():
    """But for the microsecond in which Python keeps it."""
    sys.setswitchinterval(SECONDS / 5)
    with brisk_switching():
        assert sys.getswitchinterval() == pytest.approx(SECONDS / 5, rel=0.02)
    assert sys.getswitchinterval() == pytest.approx(SECONDS / 5, rel=0.02)
