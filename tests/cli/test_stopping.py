"""Ctrl-C ends the program in order: its status says so, and no file is half there."""

import os
import signal
import subprocess
import sys

import pytest

from glanz.engine import write_scene
from glanz.tests import helpers


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_while_rendering_stops_without_a_traceback_or_file(tmp_path, number, status):
    scene = helpers.scene([helpers.thing(helpers.box())], world=0.5)
    # Hours of work, so that the signal comes in the middle of it.
    write_scene(tmp_path / "a.glanz", scene, helpers.settings(width=2000, height=2000, samples=10_000))
    command = [sys.executable, "-m", "glanz.cli", "render", "a.glanz", "-o", "a.exr"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        first = process.stderr.readline()
        process.send_signal(number)
        rest = process.stderr.read()
        assert process.stdout.read() == ""
    assert "2000x2000" in first
    assert process.returncode == status
    assert rest == f"glanz: stopped by {signal.Signals(number).name}\n"
    assert os.listdir(tmp_path) == ["a.glanz"]


@pytest.mark.parametrize("module", ["glanz.engine", "numpy"])
def test_a_signal_while_modules_load_ends_at_once(module):
    program = f"""
import os, signal, sys
from glanz.cli.stopping import Stopper
Stopper().install()
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "{module}":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Finder())
import {module}
print("went on")
"""
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (result.returncode, result.stdout, result.stderr) == (130, "", "glanz: stopped by SIGINT\n")
