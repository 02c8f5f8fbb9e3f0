"""What accuracy costs in the open file, measured by `glanz bench` in a process of its own, so that Blender is not held up.

The process works on a copy of the file in a temporary folder, so that unsaved changes count. What it says goes to a file there,
which is read now and then; what it found is read from the table that it writes.
"""

import contextlib
import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import bpy

from .reports import counted

_DONE = re.compile(r"^glanz: (\d+)% done", re.MULTILINE)
_WARNING = "glanz: warning: "
_ERROR = "glanz: error: "
_FAREWELLS = ("", "Blender quit")
"""What Blender says last, however it ends."""
_NO_WINDOW = getattr(subprocess, "CREATE_NO_WINDOW", 0)
"""Windows would open a terminal."""


@dataclass(frozen=True)
class Row:
    """Settings that nothing beats in both time [s] and `error`, the RMSE over the mean; `kind`: "noise", "bias" or both."""

    settings: str
    seconds: float
    error: float
    kind: str


@dataclass(frozen=True)
class Outcome:
    """How a measurement has ended: with rows, or with a `problem`; `folder` holds the whole table."""

    title: str
    folder: Path
    rows: tuple = ()
    warnings: tuple = ()
    problem: str = ""


class Measurement:
    """One that runs. `title` says of what; `done` in [0, 1].

    command  the words that start it, of which `-o folder` is a part
    scratch  a `tempfile.TemporaryDirectory` of its own, removed in the end

    Raises OSError if it cannot be started.
    """

    def __init__(self, title, command, folder, scratch):
        self.title, self.done = title, 0.0
        self._folder, self._scratch = folder, scratch
        self._log = Path(scratch.name, "log.txt")
        with open(self._log, "wb") as log:
            self._child = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, creationflags=_NO_WINDOW
            )

    def poll(self):
        """The `Outcome`, None while it runs."""
        status = self._child.poll()
        text = self._log.read_text("utf-8", errors="replace")
        if status is None:
            self.done = share_done(text)
            return None
        self.end()
        warnings = tuple(line.removeprefix(_WARNING) for line in text.splitlines() if line.startswith(_WARNING))
        if status:
            return Outcome(self.title, self._folder, (), warnings, problem(text, status))
        try:
            return Outcome(self.title, self._folder, read_rows(self._folder / "curve.json"), warnings)
        except (OSError, ValueError, KeyError, TypeError) as error:
            return Outcome(self.title, self._folder, (), warnings, f"there is no table in {self._folder}: {error}; {problem(text, status)}")

    def end(self):
        """Stop its process, if that still runs, and remove what it worked on, and an empty folder."""
        self._child.kill()
        self._child.wait()
        self._scratch.cleanup()
        with contextlib.suppress(OSError):  # It holds something.
            self._folder.rmdir()


def start(scene, layer):
    """A `Measurement` of the open file's scene and view layer, as they are now. Raises OSError, and RuntimeError if Blender cannot save."""
    folder = output_folder()
    scratch = tempfile.TemporaryDirectory(prefix="glanz_bench_", ignore_cleanup_errors=True)
    try:
        copy = Path(scratch.name, "scene.blend")
        bpy.ops.wm.save_as_mainfile(filepath=str(copy), copy=True, check_existing=False)
        title = f"{Path(bpy.data.filepath).name or 'unsaved file'}, {scene.name}"
        return Measurement(title, command(copy, folder, scene.name, layer.name), folder, scratch)
    except BaseException:
        scratch.cleanup()
        raise


def output_folder():
    """glanz_bench beside the .blend file, for an unsaved one a new temporary folder. Raises OSError if nothing can be written there."""
    if not bpy.data.filepath:
        return Path(tempfile.mkdtemp(prefix="glanz_bench_"))
    folder = Path(bpy.data.filepath).parent / "glanz_bench"
    if not os.access(folder if folder.exists() else folder.parent, os.W_OK):
        raise PermissionError(f"cannot write to {folder}; save the file elsewhere")
    return folder


def command(path, folder, scene_name, layer_name):
    """The words that measure the .blend file `path` in a Blender of its own, or in Python where Blender is a module of it."""
    package = __package__.rpartition(".")[0]
    program = bpy.app.binary_path
    # Also where the preferences have not been saved since Glanz was enabled.
    start = [program, "--addons", package, "--command", "glanz"] if program else [sys.executable, "-m", f"{package}.cli"]
    return [*start, "bench", str(path), "-o", str(folder), f"--scene={scene_name}", f"--view-layer={layer_name}"]


def share_done(text):
    """In [0, 1], as the process said last in `text`."""
    found = _DONE.findall(text)
    return int(found[-1]) / 100 if found else 0.0


def problem(text, status):
    """Why the process failed: the error that it told, or else its last line."""
    lines = [line.strip() for line in text.splitlines() if line.strip() not in _FAREWELLS]
    errors = [line.removeprefix(_ERROR) for line in lines if line.startswith(_ERROR)]
    said = (errors or lines or ["it said nothing"])[-1]
    return said if errors else f"the process ended with status {status}: {said}"


def read_rows(path):
    """(Row, ...) of the Pareto front in a curve.json, by time. Raises OSError, ValueError, KeyError or TypeError if it is none."""
    rungs = json.loads(path.read_text("utf-8"))["rungs"]
    best = sorted((rung for rung in rungs if rung["is_best"]), key=lambda rung: rung["seconds"])
    return tuple(Row(_in_words(rung), rung["seconds"], rung["rmse"], rung["kind"]) for rung in best)


def _in_words(rung):
    words = f"{rung['integrator']}, {rung['sampler']}, {counted(rung['samples'], 'sample')}, depth {rung['max_depth']}"
    return words if rung["precision"] == "fast" else f"{words}, {rung['precision']}"
