"""What is rendered is not lost: a render goes on from its checkpoint to the same bits (catalogue H4)."""

import errno
import json
import os
import signal
import subprocess
import sys
import time
import zipfile

import numpy as np
import OpenEXR
import pytest

from glanz.engine import Checkpoint, FileError, SceneError, render, write_scene
from glanz.engine.io import checkpoint as module
from glanz.engine.rendering import gathered
from glanz.engine.wavefront.film import Film
from glanz.tests import helpers as h, scenes

SETTINGS = {"width": 24, "height": 20, "samples": 32, "max_depth": 2, "tile_size": 8, "threads": 2}
PASSES = ("Combined", "Standard Error", "Confidence", "Sample Count", "CryptoObject00", "Depth", "Diffuse Color", "Diffuse Direct")
WAYS = {
    "tiles": ({}, ()),
    "whole frame": ({"tile_size": 0}, (1, 2, 4, 8, 16)),
    "negative lobes": ({"pixel_filter": "mitchell", "passes": ("Combined", "CryptoObject00")}, (1, 3, 9)),
    "error target": ({"samples": 1024, "error_target": 0.05}, ()),
    "part of the samples": ({"sample_range": (5, 29)}, (8, 16)),
    "divided pixels": ({"adaptive_threshold": 0.1, "samples": 2, "passes": ("Combined",)}, ()),
}


class Killed(Exception):
    """In the place of a crash."""


def rendered(settings, ends, checkpoint=None, killed_after=None):
    """{pass: (H, W, C)}; Killed after so many tiles, with the pieces of progress that they came in."""
    tiles = steps = 0

    def on_progress(progress):
        nonlocal tiles, steps
        tiles, steps = tiles + len(progress.tiles), steps + bool(progress.tiles)
        if killed_after is not None and tiles > killed_after:
            raise Killed(steps)

    more = {"checkpoint": checkpoint} if checkpoint else {}
    passes, _, reached = gathered(render(scenes.everything(), settings, ends, **more), settings, on_progress)
    return passes, reached


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("killed_after", [1, 2, 4])
def test_a_render_goes_on_to_the_same_bits(way, killed_after, tmp_path):
    changes, ends = WAYS[way]
    settings = h.settings(**SETTINGS | {"passes": PASSES} | changes)
    whole, ended = rendered(settings, ends)
    path = tmp_path / "a.checkpoint"
    with pytest.raises(Killed) as killed:
        rendered(settings, ends, Checkpoint(path, scenes.everything(), settings, 1e-6), killed_after)
    is_saved = path.exists()
    parts, reached = rendered(settings, ends, Checkpoint(path, scenes.everything(), settings, 1e-6))
    # Nothing is saved before the first is seen.
    assert is_saved or killed.value.args == (1,)
    assert (reached.samples, reached.ended_by) == (ended.samples, ended.ended_by)
    for key in settings.passes:
        assert h.same_bits(whole[key], parts[key]), key


def test_what_is_saved_is_not_rendered_again(tmp_path, monkeypatch):
    """After the whole frame has 16 of 32 samples, the other half is all that is traced."""
    settings = h.settings(**SETTINGS | {"tile_size": 0})
    path = tmp_path / "a.checkpoint"
    with pytest.raises(Killed):
        rendered(settings, (16,), Checkpoint(path, scenes.everything(), settings, 1e-6), killed_after=1)
    traced, close = [], Film.close

    def counted(self, is_first):
        traced.append(self._count)
        close(self, is_first)

    monkeypatch.setattr(Film, "close", counted)
    rendered(settings, (16,), Checkpoint(path, scenes.everything(), settings, 1e-6))
    assert sum(traced) == 16


def test_a_sum_that_is_not_saved_is_noticed(tmp_path, monkeypatch):
    """The mutant: what was gathered before is lost."""
    state = Film.state
    monkeypatch.setattr(Film, "state", lambda self: state(self) | {"sum.Combined": 0 * self.sums["Combined"]})
    with pytest.raises(AssertionError):
        test_a_render_goes_on_to_the_same_bits("whole frame", 2, tmp_path)


@pytest.fixture
def saved(tmp_path):
    """(path of a checkpoint, its settings)."""
    settings = h.settings(**SETTINGS)
    path = tmp_path / "a.checkpoint"
    with pytest.raises(Killed):
        rendered(settings, (16,), Checkpoint(path, scenes.everything(), settings, 1e-6), killed_after=12)
    return path, settings


@pytest.mark.parametrize("changes", [{"seed": 1}, {"samples": 33}, {"max_depth": 3}, {"tile_size": 16}], ids=str)
def test_another_render_does_not_go_on_from_it(saved, changes):
    path, settings = saved
    other = h.replaced(settings, **changes)
    with pytest.raises(FileError, match=r"cannot go on from '.*a.checkpoint': it is of another scene, or of other settings; delete it"):
        rendered(other, (), Checkpoint(path, scenes.everything(), other))


def test_another_scene_does_not_go_on_from_it(saved):
    path, settings = saved
    with pytest.raises(FileError, match="it is of another scene"):
        Checkpoint(path, h.scene(world=0.5), settings).load()


def test_threads_make_no_difference(saved):
    path, settings = saved
    assert Checkpoint(path, scenes.everything(), h.replaced(settings, threads=1)).load().tiles


def rewritten(path, change):
    """The entries of a checkpoint, changed."""
    with zipfile.ZipFile(path) as file:
        entries = {name: file.read(name) for name in file.namelist()}
    entries = change(entries)
    with zipfile.ZipFile(path, "w") as file:
        for name, data in entries.items():
            file.writestr(name, data)


def with_head(entries, **changes):
    head = json.loads(entries[module.HEAD])
    return entries | {module.HEAD: json.dumps(head | changes).encode()}


@pytest.mark.parametrize(
    "damage",
    [
        lambda path: path.write_bytes(b""),
        lambda path: path.write_bytes(path.read_bytes()[:-100]),
        lambda path: path.write_bytes(b"PK\3\4" + os.urandom(100)),
        lambda path: rewritten(path, lambda e: {k: v for k, v in e.items() if not k.startswith("tiles/1/")}),
        lambda path: rewritten(path, lambda e: with_head(e, version=99)),
        lambda path: rewritten(path, lambda e: with_head(e, tiles=7)),
        lambda path: rewritten(path, lambda e: with_head(e, reached=None)),
        lambda path: rewritten(path, lambda e: {k: b"\x80\x04." if k.endswith(".npy") else v for k, v in e.items()}),
    ],
    ids=["empty", "cut", "garbage", "missing tiles", "another version", "no tiles", "nothing reached", "pickles"],
)
def test_a_damaged_file_is_refused_by_name(saved, damage):
    path, settings = saved
    damage(path)
    with pytest.raises(FileError, match=r"cannot go on from '.*a\.checkpoint'"):
        rendered(settings, (), Checkpoint(path, scenes.everything(), settings))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda saved: h.replaced(saved, tiles={(7, 0, 8, 8): {}}), "other tiles"),
        (lambda saved: h.replaced(saved, tiles={place: {} for place in saved.tiles}), "another film"),
        (lambda saved: h.replaced(saved, ending={}), "looked"),
        (lambda saved: h.replaced(saved, finished={place: {} for place in saved.tiles}), "other passes"),
    ],
    ids=["tiles", "films", "endings", "passes"],
)
def test_what_does_not_fit_is_refused_before_the_work(saved, monkeypatch, change, told):
    """A file that is whole, and says that it is of this render, but is not."""
    path, settings = saved
    load = Checkpoint.load
    monkeypatch.setattr(Checkpoint, "load", lambda self: change(load(self)))
    with pytest.raises(SceneError, match=rf"the checkpoint does not fit what is rendered \(.*{told}.*\); delete it to begin anew"):
        rendered(settings, (), Checkpoint(path, scenes.everything(), settings))


@pytest.mark.parametrize("ends", [(), (1, 2, 4, 8, 16)], ids=["tiles", "whole frame"])
def test_a_full_disk_costs_the_checkpoint_and_not_the_picture(ends, tmp_path, monkeypatch):
    settings = h.settings(**SETTINGS)
    whole, _ = rendered(settings, ends)

    def full(file, name, data):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(module, "add_entry", full)
    path = tmp_path / "a.checkpoint"
    steps = list(render(scenes.everything(), settings, ends, Checkpoint(path, scenes.everything(), settings, 1e-6)))
    passes, warnings, _ = gathered(steps, settings)
    assert h.same_bits(passes["Combined"], whole["Combined"])
    (told,) = warnings
    assert told == f"rendering goes on, but the last checkpoint is old or missing: cannot write '{path}': No space left on device"
    assert not list(tmp_path.iterdir())


def test_where_nothing_can_be_written_is_said_at_once(tmp_path):
    with pytest.raises(FileError, match="cannot write"):
        Checkpoint(tmp_path / "no folder" / "a", scenes.everything(), h.settings(**SETTINGS))


def killed_at(moments, tmp_path):
    """A render of the command line that is killed so many seconds after it has written anything, and begun again: pixels as in one go.

    How often it was killed while there was something to go on from.
    """
    settings = h.settings(**SETTINGS | {"samples": 256, "width": 48, "height": 40})
    write_scene(tmp_path / "a.glanz", scenes.everything(), settings)
    main = "import sys; from glanz.cli.main import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", main, "render", str(tmp_path / "a.glanz"), "-o"]
    subprocess.run([*command, str(tmp_path / "whole.exr")], check=True, capture_output=True)
    file = tmp_path / "a.checkpoint"
    command += [str(tmp_path / "parts.exr"), "--checkpoint", str(file), "--checkpoint-seconds", "0.05"]
    survived = 0
    for moment in moments:
        before = file.stat().st_mtime_ns if file.exists() else 0
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not (file.exists() and file.stat().st_mtime_ns > before):
            time.sleep(0.002)
        time.sleep(moment)
        process.send_signal(signal.SIGKILL)
        process.wait()
        survived += file.exists()
    subprocess.run(command, check=True, capture_output=True)
    assert not file.exists()
    whole, parts = (channels(tmp_path / f"{name}.exr") for name in ("whole", "parts"))
    assert whole.keys() == parts.keys()
    assert all(h.same_bits(whole[key], parts[key]) for key in whole)
    return survived


def channels(path):
    """{name: (H, W)} of an EXR file."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: channel.pixels.copy() for name, channel in file.channels().items()}


@pytest.mark.skipif(sys.platform == "win32", reason="processes are not killed like this on Windows")
def test_what_is_killed_goes_on_to_the_same_pixels(tmp_path):
    assert killed_at((0.0, 0.03), tmp_path) >= 1


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform == "win32", reason="processes are not killed like this on Windows")
def test_what_is_killed_at_twenty_moments_goes_on_to_the_same_pixels(tmp_path):
    rng = np.random.default_rng(int(os.environ.get("GLANZ_SEED", "1")))
    assert killed_at(rng.uniform(0.0, 0.1, 20), tmp_path) >= 5
