"""What grows as a power of the size has that power as its slope, and projections obey the laws they are named after."""

import json
import math
import subprocess

import numpy as np
import pytest

from glanz.benchmarks.growth import gil, report
from glanz.benchmarks.growth.__main__ import rung
from glanz.benchmarks.growth.ladders import LADDERS
from glanz.benchmarks.growth.measure import amdahl, behind_a_lock, serial_share, share_and_error, slope, slope_at_the_end
from glanz.engine import Requirements

SIZES = np.array([1e3, 1e4, 1e5, 1e6, 1e7])
FACTS = {"processor": "P", "cores": 2, "load": 0.1, "python": "3.11", "date": "today", "quick": False}


@pytest.mark.parametrize("power", [0.0, 0.5, 1.0, 2.0])
def test_slope_is_the_power(power):
    assert slope(SIZES, 3e-6 * SIZES**power) == pytest.approx(power, abs=1e-9)


def test_slope_at_the_end_forgets_what_is_paid_once():
    values = 1.0 + 1e-4 * SIZES
    assert slope(SIZES, values) < 0.8
    assert slope_at_the_end(SIZES, values) == pytest.approx(1.0, abs=0.03)
    assert slope_at_the_end(SIZES[::-1], values[::-1]) == pytest.approx(slope_at_the_end(SIZES, values))


def test_slope_leaves_out_what_is_not_above_zero_and_is_unknown_without_two():
    assert slope([1, 10, 100], [0, 5, 50]) == pytest.approx(1.0)
    assert math.isnan(slope([1, 10], [0, 5]))


@pytest.mark.parametrize("serial", [0.0, 0.05, 0.5, 1.0])
def test_serial_share_is_found_again(serial):
    assert serial_share({n: 7 / amdahl(serial, n) for n in (1, 2)}) == pytest.approx(serial)
    assert serial_share({n: 7 / amdahl(serial, n) for n in (1, 2, 4, 8)}) == pytest.approx(serial)


def test_serial_share_stays_a_share():
    assert serial_share({1: 1.0, 2: 0.4}) == 0
    assert serial_share({1: 1.0, 2: 1.3}) == 1


@pytest.mark.parametrize("share", [0.05, 0.3, 0.8])
def test_threads_behind_a_lock(share):
    """One thread is one, two are 2 / (1 + share^2), many are 1 / share; never above what a lock allows, never below Amdahl."""
    assert behind_a_lock(share, 1) == pytest.approx(1)
    assert behind_a_lock(share, 2) == pytest.approx(2 / (1 + share**2))
    assert behind_a_lock(share, 1000) == pytest.approx(1 / share, rel=1e-3)
    for n in (2, 4, 16, 64):
        assert amdahl(share, n) < behind_a_lock(share, n) < min(n, 1 / share) + 1e-9


def test_threads_behind_a_lock_agree_with_a_simulation():
    """Three threads, each alternately at work and at the lock, for 40,000 turns in all; standard error below 1 %."""
    rng, share, threads, turns = np.random.default_rng(1), 0.4, 3, 40_000
    arrivals, free, end = rng.exponential(1 - share, threads), 0.0, 0.0
    for work, hold in zip(rng.exponential(1 - share, turns), rng.exponential(share, turns)):
        first = arrivals.argmin()
        end = free = max(free, arrivals[first]) + hold
        arrivals[first] = end + work
    assert turns / end == pytest.approx(behind_a_lock(share, threads), rel=0.03)


def test_stacks_of_holders_are_counted_against_all_samples():
    hits, samples = gil.counted("main (a b.py:1);f (c.py:2) 12\nmain (a b.py:1) 30\n", "Wrote raw flamegraph data. Samples: 42 Errors: 2")
    assert (hits, samples) == (42, gil.RATE * gil.SECONDS - 2)
    share, error = share_and_error(42, 100)
    assert (share, error) == (0.42, pytest.approx(0.0494, abs=1e-3))
    assert share_and_error(0, 100)[1] > 0
    assert math.isnan(share_and_error(0, 0)[0])


def test_without_py_spy_the_cure_is_named(monkeypatch, capsys):
    monkeypatch.setattr(gil, "find", lambda: None)
    assert gil.held("threads", 1) == {}
    assert "pip install py-spy" in capsys.readouterr().err


@pytest.mark.parametrize("name", LADDERS)
def test_ladders_rise_and_scenes_have_as_much_as_they_say(name):
    ladder = LADDERS[name]
    assert all(a < b for a, b in zip(ladder.sizes, ladder.sizes[1:])) and 2 <= ladder.quick <= len(ladder.sizes)
    size = ladder.sizes[1]
    scene, settings = ladder.rung(size)
    objects, bitmaps = scene.objects, [o.materials[0].lobes[0].reflectance for o in scene.objects]
    has = {
        "pixels": lambda: settings.width * settings.height,
        "samples": lambda: settings.samples,
        "triangles": lambda: sum(o.mesh.triangles.shape[1] for o in objects),
        "lights": lambda: len(scene.lights),
        "textures": lambda: len({id(texture.bitmap) for texture in bitmaps}),
        "texels": lambda: math.prod(bitmaps[0].bitmap.pixels.shape[1:]),
        "threads": lambda: settings.threads,
    }
    assert has[name]() == pytest.approx(size, rel=0.02)
    assert Requirements.of(scene, settings)


def test_the_smallest_rung_from_end_to_end(tmp_path):
    """In a process of its own, and on the page."""
    found = rung("texels", LADDERS["texels"].sizes[0])
    assert found["size"] == 4096 and found["rounds"] >= 1
    assert min(found["prepare"], found["render"], found["wall"]) > 0
    assert found["memory"] >= 0
    larger = found | {"size": 8192, "prepare": 2 * found["prepare"]}
    results = json.loads(json.dumps({"facts": FACTS, "ladders": {"texels": [found, larger]}}))
    assert "| texels, to 8,192 | 1, 1 | 0, 0 |" in report.page(results)
    pytest.importorskip("matplotlib")
    report.plot(results, tmp_path / "growth.png")
    assert (tmp_path / "growth.png").stat().st_size > 1000


def test_a_rung_that_fails_says_why(monkeypatch):
    failed = subprocess.CompletedProcess([], 1, stdout="{}\n", stderr="MemoryError: too much")
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: failed)
    with pytest.raises(SystemExit, match=r"texels 9 failed with status 1:\s[^$]*MemoryError: too much"):
        rung("texels", 9)


def test_page_says_what_is_projected_and_when_not_to_trust_it():
    seconds = {1: 10.0, 2: 10.0 / amdahl(0.1, 2)}
    rungs = [{"size": n, "wall": s, "render": s, "gil": {"share": 0.2, "error": 0.01}} for n, s in seconds.items()]
    quiet = report.page({"facts": FACTS, "ladders": {"threads": rungs}})
    assert "**A projection, not a measurement**" in quiet and "busy machine" not in quiet and "quick" not in quiet
    assert "serial share 0.100" in quiet and f"| {amdahl(0.1, 64):.1f} | 10.0 |" in quiet
    assert f"| {behind_a_lock(0.2, 64):.1f} | 5.0 |" in quiet
    busy = report.page({"facts": FACTS | {"load": 9.0, "quick": True}, "ladders": {"threads": rungs}})
    assert "**Measured on a busy machine**" in busy and "**The quick ladders**" in busy
    assert "serial share 0.1" not in busy and f"| {behind_a_lock(0.2, 64):.1f} | 5.0 |" in busy
