"""Whatever a .blend file says, a render ends with a finite picture, or is refused by a reason for a user; Blender lives on (J15-J18, J1).

Files are drawn at random, see `mutations`, and rendered in a process of their own, in which a crash and a hang are noticed too.
"""

import math
import subprocess
import sys

import bpy
import pytest

from glanz.addon import results
from glanz.tests import chance
from glanz.tests.addon import mutations

QUICK, THOROUGH = 40, 3000


def ended(*words, timeout=None):
    """(exit status, what was said last) of files that are rendered in a process of their own."""
    done = subprocess.run([sys.executable, *words], capture_output=True, text=True, errors="replace", timeout=timeout)
    lines = (done.stdout + done.stderr).splitlines()
    faults = [line for line in lines if line.startswith("FAULT")]
    return done.returncode, "\n".join((*faults, "...", *lines[-60:]))


@pytest.mark.thorough
def test_any_file_renders_to_finite_numbers_or_is_refused():
    count, seed = (QUICK, 1) if chance.SEED is None else (THOROUGH, int(chance.SEED))
    # Blender grows with every file.
    for first in range(0, count, 500):
        status, said = ended("-m", mutations.__name__, str(seed), str(first), str(min(500, count - first)))
        assert status == 0, said


def test_the_same_seed_makes_the_same_file():
    logs = [mutations.Mutated(1, number).log for number in (3, 4, 3)]
    assert logs[0] == logs[2] != logs[1]


def test_a_picture_that_is_not_finite_is_a_fault(tmp_path, monkeypatch):
    """The mutant writes NaN where white is."""
    mutations.Mutated(1, 0)
    assert mutations.fault_of(tmp_path) is None
    flat = results.flat_pixels
    monkeypatch.setattr(results, "flat_pixels", lambda values: flat(values) * math.nan)
    assert "is not finite" in mutations.fault_of(tmp_path)


def test_an_error_of_a_developer_is_a_fault_and_one_of_a_user_is_none(tmp_path, monkeypatch):
    mutations.Mutated(1, 0)
    bpy.context.scene.camera.data.type = "PANO"
    bpy.context.scene.camera.data.panorama_type = "MIRRORBALL"
    assert mutations.fault_of(tmp_path) is None
    monkeypatch.setattr(results, "make_room", lambda *args: 1 / 0)
    assert "ZeroDivisionError" in mutations.fault_of(tmp_path)


@pytest.mark.parametrize(("what", "told"), [("while True: pass", "Timeout"), ("m.faulthandler._sigsegv()", "Segmentation fault")])
def test_a_hang_and_a_crash_are_noticed_and_the_file_is_told(what, told):
    mutant = f"import glanz.tests.addon.mutations as m; m.HANGS = 1\ndef fault_of(folder):\n {what}\nm.fault_of = fault_of\nm.main(1, 7)"
    status, said = ended("-c", mutant, timeout=120)
    assert status != 0
    assert told in said
    assert "file 7 of seed 1" in said
