"""Whatever is written, a full disk leaves the old file whole and no other, and says so (fault J10). EXR files: `test_exr`."""

import os
import resource

import numpy as np
import pytest

from glanz.engine import Checkpoint, FileError, Image, write_exr, write_scene
from glanz.engine.io import atomic
from glanz.engine.io.png import write_png
from glanz.engine.saved import Saved
from glanz.tests import helpers as h

PICTURE = Image(64, 64, {"Combined": np.random.default_rng(1).random((64, 64, 4), np.float32)})
SCENE = h.scene([h.thing(h.icosphere(2))])


def save_checkpoint(path):
    Checkpoint(path, SCENE, h.settings()).save(Saved(tiles={(0, 0, 8, 8): {"sum": np.ones((3, 64))}}))


def save_png(path):
    pytest.importorskip("PIL", reason="Pillow is not installed")
    write_png(path, PICTURE)


WRITERS = {
    "picture.exr": lambda path: write_exr(path, PICTURE),
    "picture.png": save_png,
    "scene.glanz": lambda path: write_scene(path, SCENE, h.settings()),
    "a.checkpoint": save_checkpoint,
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_leaves_the_old_file_and_no_other(name, tmp_path):
    target, write = tmp_path / name, WRITERS[name]
    write(target)
    old = target.read_bytes()
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    for limit in (1, len(old) // 2, len(old) - 1):
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, before[1]))
        try:
            with pytest.raises(FileError, match=rf"cannot write '{target}'"):
                write(target)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
        assert target.read_bytes() == old
        assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("name", WRITERS)
def test_what_gets_its_name_is_on_the_disk(name, tmp_path, monkeypatch):
    """Else a system that crashes may leave the new name with nothing in it."""
    done, sync, rename = [], os.fsync, os.replace
    monkeypatch.setattr(atomic.os, "fsync", lambda file: done.append("flushed") or sync(file))
    monkeypatch.setattr(atomic.os, "replace", lambda *paths: done.append("named") or rename(*paths))
    WRITERS[name](tmp_path / name)
    assert done == ["flushed", "named"]
