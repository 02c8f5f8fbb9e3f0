"""Tiles land where they belong, and every result is ended once."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from glanz.addon.results import Outlines, flat_pixels, make_room, open_result, place_in_result
from glanz.engine import MemoryShortage, Settings, Tile, memory


class Engine:
    """Stands for Blender's engine: counts how often results are begun and ended."""

    def __init__(self, granted=None):
        self.granted, self.ended = granted, []

    def begin_result(self, x, y, width, height, layer, view):
        if self.granted == "nothing":
            return None
        width, height = self.granted or (width, height)
        return SimpleNamespace(resolution_x=width, resolution_y=height, layers=[], views=[])

    def end_result(self, result, cancel):
        self.ended.append(cancel)


def test_rows_are_turned_upside_down():
    values = np.arange(12, dtype=np.float64).reshape(2, 3, 2)
    flat = flat_pixels(values)
    assert flat.dtype == np.float32
    assert flat.tolist() == [6, 7, 8, 9, 10, 11, 0, 1, 2, 3, 4, 5]


def test_places_count_from_the_bottom_left_of_the_border():
    tile = Tile(x=12, y=20, width=8, height=5, passes={})
    assert place_in_result(tile, (0, 0, 100, 50)) == (12, 25, 8, 5)
    assert place_in_result(tile, (10, 15, 60, 40)) == (2, 15, 8, 5)


def test_a_good_result_is_ended_once_and_kept():
    engine = Engine()
    with open_result(engine, (0, 0, 4, 4), "Layer"):
        pass
    assert engine.ended == [False]


def test_a_bad_result_is_ended_once_and_dropped():
    engine = Engine()
    with pytest.raises(KeyboardInterrupt), open_result(engine, (0, 0, 4, 4), "Layer"):
        raise KeyboardInterrupt
    assert engine.ended == [True]


@pytest.mark.parametrize(("granted", "ended"), [("nothing", []), ((2, 4), [True])])
def test_a_result_that_is_not_what_was_asked_for_is_an_error(granted, ended):
    engine = Engine(granted)
    with pytest.raises(RuntimeError, match="Blender"), open_result(engine, (0, 0, 4, 4), "Layer"):
        pytest.fail("must not be entered")
    assert engine.ended == ended


def test_what_is_worked_on_is_outlined_and_nothing_else():
    """Counted from the bottom left of the border; what stays is outlined again, for its unfinished results took that away."""
    shown = set()

    class Screen(Engine):
        def tile_highlight_clear_all(self):
            shown.clear()

        def tile_highlight_set(self, x, y, width, height, is_on):
            assert is_on
            shown.add((x, y, width, height))

    engine = Screen()
    outlines = Outlines(engine, (0, 0, 200, 100))
    assert engine.use_highlight_tiles
    outlines.show(((0, 0, 8, 8), (8, 0, 8, 5)))
    assert shown == {(0, 92, 8, 8), (8, 95, 8, 5)}
    outlines.show(((8, 0, 8, 5), (16, 92, 8, 8)))
    assert shown == {(8, 95, 8, 5), (16, 0, 8, 8)}
    outlines.show(())
    assert not shown
    Outlines(engine, (10, 20, 60, 80)).show(((10, 20, 8, 8),))
    assert shown == {(0, 52, 8, 8)}


HUGE = Settings(width=16384, height=16384, passes=("Combined", "Depth"))


def test_a_frame_that_has_no_room_is_refused_before_blender_is_asked(monkeypatch):
    """To the byte, where the system says what is free, and where it does not."""
    needed = 2 * 4 * 5 * 16384 * 16384
    engine = Engine()
    monkeypatch.setattr(memory, "free", lambda: (needed - 1) / memory.SHARE)
    told = r"Blender's picture and its copy, 16384x16384 px with 5 channels, need about 10\.0 GiB of memory, .*: lower the resolution"
    with pytest.raises(MemoryShortage, match=told):
        make_room(engine, HUGE, "Layer")

    def refuse(size, dtype):
        assert size == needed
        raise MemoryError

    monkeypatch.setattr(memory, "free", lambda: needed / memory.SHARE + 1)
    monkeypatch.setattr("glanz.addon.results.np.empty", refuse)
    with pytest.raises(MemoryShortage, match=r"16384x16384 px with 5 channels, take 10\.0 GiB of memory, which are not to be had: lower"):
        make_room(engine, HUGE, "Layer")
    assert engine.ended == []


def test_all_view_layers_eyes_and_the_frame_around_a_border_count(monkeypatch):
    """Three channels of normals more in one of two layers, for each of two eyes; the border is a quarter."""
    scene = bpy.context.scene
    scene.view_layers.new("Other").use_pass_normal = True
    scene.render.use_multiview = scene.render.use_border = True
    told = []
    monkeypatch.setattr("glanz.addon.results.require_memory", lambda needed, what, cure: told.append((needed, what)))
    make_room(Engine(), Settings(width=100, height=80, border=(0, 0, 50, 40)), "Layer", scene)
    (needed, what), channels = told[0], 2 * (4 + 4 + 3)
    assert needed == 4 * channels * (50 * 40 + 100 * 80)
    assert f"50x40 px with {channels} channels" in what
