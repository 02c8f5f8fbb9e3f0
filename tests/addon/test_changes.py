"""Whatever a user changes, in whatever order, a render follows: no exception, no crash, no memory that is never given back."""

import gc
import os
import random
import re
from pathlib import Path

import numpy as np
import pytest

from glanz.tests.addon import blender, changes
from glanz.tests.chance import SEED

BEFORE_MEASURING = 20
"""Changes until caches and libraries have what they need."""
MOST_GROWTH = 50.0
"""Megabytes."""


def resident_megabytes():
    gc.collect()
    return int(re.search(r"VmRSS:\s+(\d+)", Path("/proc/self/status").read_text())[1]) / 1024


def change_and_render(seed, count, path, step=4):
    """`count` changes, a render after each `step`; returns by how many megabytes the process grew."""
    made = changes.Changes(random.Random(seed))
    before = None
    refused = 0
    for n in range(0, count, step):
        made.make(step)
        try:
            blender.render(path)
        except RuntimeError as error:
            # As one whose parent is flat: with another camera it goes on.
            assert str(error).startswith("Error: camera 'Camera"), f"seed {seed}, after {made.log}"
            refused += 1
            made.new_camera()
            continue
        # The eyes of a stereo camera have a file each.
        pictures = [*path.parent.glob(f"{path.stem}*.exr")]
        assert pictures
        for picture in pictures:
            for name, values in blender.read_exr(picture).items():
                assert not np.isnan(values).any(), f"seed {seed}, NaN in {name} after {made.log}"
            picture.unlink()
        if before is None and n >= BEFORE_MEASURING and os.path.exists("/proc/self/status"):
            before = resident_megabytes()
    assert refused <= count / step / 4
    return resident_megabytes() - before if before else 0.0


@pytest.mark.thorough
@pytest.mark.parametrize(("seed", "count"), [(1, 60)] if SEED is None else [(int(SEED) + n, 200) for n in range(8)])
def test_any_changes_can_be_rendered(tmp_path, seed, count):
    assert change_and_render(seed, count, tmp_path / "a.exr") <= MOST_GROWTH


def test_memory_that_is_never_given_back_is_noticed(tmp_path, monkeypatch):
    kept = []
    render = blender.render

    def leaking(path):
        kept.append(np.ones(2**20))
        return render(path)

    monkeypatch.setattr(blender, "render", leaking)
    assert change_and_render(1, 64, tmp_path / "a.exr") > MOST_GROWTH
