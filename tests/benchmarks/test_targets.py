"""Errors against the mean of other pictures are those against the truth."""

import json
import subprocess
import sys

import numpy as np
import pytest

from glanz.benchmarks import targets


def test_the_error_against_the_others_is_that_against_the_truth():
    """Of 20 pictures of 10,000 values with a relative noise of 2 %: each is known to 0.7 %, and to what the others say of its luck."""
    rng = np.random.default_rng(1)
    truth = rng.uniform(1, 3, (50, 67, 3))
    pictures = truth + rng.normal(0, 0.02 * truth.mean(), (20, *truth.shape))
    exact = [np.sqrt(np.square(p - truth).mean()) / truth.mean() for p in pictures]
    assert targets.errors(pictures) == pytest.approx(exact, rel=0.01)


def test_pictures_are_counted_as_the_bounds_say():
    assert targets.inside({"reached": [0.69, 0.7, 1.0, 1.05, 1.06]}) == 3
    one = {"reached": [0.9] * 20, "stated": [0.95] * 20, "samples": [400] * 20, "most": 16384, "date": "2026-01-31"}
    never = {"reached": [], "stated": [3.1], "samples": [16384], "most": 16384, "date": "2026-02-01"}
    text = targets.page({"facts": {"side": 32, "seeds": 20}, "scenes": {"one": one, "never": never}})
    assert "20 of 20 pictures reached 0.7 to 1.05 times the target.\n1 of the 2 scenes got that far" in text
    assert "in 1 of these 19 of 20 pictures did" in text
    assert "| never | not within 16,384 samples | | 3.10 | | 16,384 | 2026-02-01 |" in text


def test_scenes_that_miss_the_bounds_are_told_beside_the_same_twice_as_wide():
    plain = {"stated": [0.9] * 20, "samples": [400] * 20, "most": 16384, "date": "2026-01-31"}
    unlucky, good = ({"reached": [0.9] * (20 - missed) + [1.1] * missed} | plain for missed in (2, 1))
    assert [targets.is_good(found) for found in (unlucky, good, {"reached": []})] == [False, True, False]
    text = targets.page({"facts": {"side": 32, "seeds": 20}, "scenes": {"one": unlucky | {"wider": good}, "two": good}})
    assert "37 of 40 pictures reached" in text
    assert "rendered once more twice as wide: 1, of which 1 kept to them there" in text
    lines = [line.split(" | ") for line in text.splitlines() if line.startswith(("| one", "| two"))]
    assert [(name, inside) for name, _, _, _, inside, *_ in lines] == [
        ("| one", "18 of 20"),
        ("| one, 64 px", "19 of 20"),
        ("| two", "19 of 20"),
    ]


def test_pictures_are_rendered_wider_only_where_the_bounds_are_missed(tmp_path, monkeypatch):
    asked = []

    def measured(pool, name, seeds, side):
        asked.append((name, side))
        reached = [1.1 if name == "prism" and side == 16 else 0.9] * seeds
        return {"reached": reached, "stated": [0.9], "samples": [64], "most": 1024, "date": "2026-01-31"}

    monkeypatch.setattr(targets, "measured", measured)
    monkeypatch.setattr(targets, "ROOT", tmp_path)
    targets.main(["--quick", "prism", "lights"], workers=1)
    assert asked == [("prism", 16), ("prism", 32), ("lights", 16)]
    kept = json.loads((tmp_path / "out/targets/targets.json").read_text(encoding="utf-8"))["scenes"]
    assert ("wider" in kept["prism"], "wider" in kept["lights"]) == (True, False)


_READ = """
import multiprocessing, os, traceback
from concurrent.futures import ProcessPoolExecutor
from glanz.benchmarks import small_scenes, targets
try:
    scene, _ = ProcessPoolExecutor(1).submit(small_scenes.load, "environment", 8, 6).result(timeout=100)
    print("read", scene.world.environment.pixels.max() > 0, flush=True)
except BaseException:
    traceback.print_exc()
finally:
    for child in multiprocessing.active_children():
        child.kill()
    os._exit(0)
"""


def test_processes_of_a_pool_read_images():
    """Those that are forked off a process with Blender have not the threads that read images, and wait for them for ever."""
    done = subprocess.run([sys.executable, "-c", _READ], capture_output=True, text=True, timeout=120)
    assert "read True" in done.stdout, done.stderr


def test_scenes_that_are_not_measured_again_stay_as_they_were(tmp_path):
    """But for those that were measured in pictures of another size: they would stand in one table with what they cannot be compared to."""
    path, wide = tmp_path / "targets.json", {"seeds": 20, "side": 32}
    first, second = ({"reached": [error], "stated": [error], "samples": [64], "most": 1024, "date": "2026-01-31"} for error in (0.8, 0.9))
    targets.keep(path, "one", first, wide)
    targets.keep(path, "two", first, wide)
    assert targets.keep(path, "one", second, wide)["scenes"] == {"one": second, "two": first}
    assert json.loads(path.read_text(encoding="utf-8"))["scenes"] == {"one": second, "two": first}
    assert targets.keep(path, "one", first, wide | {"side": 16})["scenes"] == {"one": first}
