"""The page about Glanz and its peers says what was measured, and of what has a bar whether it is held."""

import re

import pytest

from glanz.benchmarks.peers import __main__ as command, report

FACTS = {"threads": 2, "processor": "P", "python": "3.11", "blender": "5.0", "date": "today", "mitsuba": "3", "variant": "llvm_ad_rgb"}
EFFORT = {"side": 256, "error_side": 128, "samples": (16, 64), "rounds": 3}


def engine(seconds, error2, load=0.0, **others):
    """Results of an engine with the error `error2` / n that takes `seconds` for 64 samples besides loading."""
    times = {
        str(n): [{"wall": load + f * seconds * n / 64, "cpu": f * seconds * n / 32, "alone": f * seconds * n / 64, "first_pixel": 0.1}] * 3
        for n, f in ((16, 1.0), (64, 1.0))
    }
    memory = {"peak": 300.0, "imported": 200.0}
    return {"times": times, "error2": {str(n): [error2 / n] for n in (16, 64)}, "mean": 1.0, "memory": memory, **others}


def results(names, cycles_seconds=4.0, agrees=True):
    """Of scenes in which Glanz takes 1 s, Cycles `cycles_seconds` and Mitsuba 2 s."""
    found = {"ratio": 1.0, "sigma": 0.001, "rmse": 0.01, "excess": 0.0, "agrees": agrees}
    scene = {
        "glanz": engine(1.0, 1.0, core={"embree_share": 60.0, "rays": 5.0}),
        "cycles": engine(cycles_seconds, 1.0),
        "mitsuba": engine(2.0, 1.0, load=0.5, cold={"wall": 3.0}),
        "mitsuba_independent": engine(2.0, 2.0, load=0.5, cold={"wall": 3.0}),
        "agreement": {"cycles": found, "mitsuba": found},
    }
    for name in ("mitsuba", "mitsuba_independent"):
        scene[name]["load"] = 0.5
    return {"facts": FACTS | {"effort": EFFORT}, "scenes": dict.fromkeys(names, scene)}


def held(found):
    """{bar: whether it is held}"""
    return {what: is_held for what, _, _, is_held in report.bars(found)}


def test_titles_are_those_of_all_scenes():
    assert tuple(report.TITLES) == command.SCENES


def test_ratios_are_those_of_the_times_and_errors():
    scene = results(command.SCENES)["scenes"]["glass"]
    assert report.at_equal_samples(scene, "cycles", "wall") == pytest.approx(0.25)
    assert report.at_equal_error(scene, "cycles", "wall") == pytest.approx(0.25)
    # Twice the squared error: twice the samples, so twice the time.
    assert report.at_equal_error(scene, "mitsuba_independent", "alone") == pytest.approx(0.25)
    assert report.relative_error(scene, "mitsuba_independent", "64") == pytest.approx(100 / 32**0.5)


def test_bars_are_held_by_what_is_fast_and_missed_by_what_is_slow():
    fast, slow = held(results(command.SCENES)), held(results(command.SCENES, cycles_seconds=1.1))
    assert fast.keys() == slow.keys()
    assert all(is_held for what, is_held in fast.items() if "Embree" not in what)
    assert not any(is_held for what, is_held in slow.items() if "Cycles" in what)
    assert not fast["Cornell box, threads' time inside Embree [%]"]


def test_a_scene_that_is_not_the_same_picture_does_not_count():
    lines = report.bars(results(command.SCENES, agrees=False))
    assert [line[1] for line in lines if "of the time of" in line[0]] == ["0 of 8", "0 of 8"]
    assert not any(line[3] for line in lines[:4])


def test_the_page_has_a_row_for_each_scene_and_says_when_the_machine_was_busy():
    found = results(command.SCENES)
    page = report.page(found)
    assert all(len(re.findall(rf"^\| {re.escape(title)} \|", page, re.M)) == 5 for title in report.TITLES.values())
    assert "busy" not in page
    found["facts"]["busy"] = 0.4
    assert "got 40 % of their threads" in report.page(found)
