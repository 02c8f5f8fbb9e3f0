"""Measure Accuracy runs beside Blender, tells what came of it, and leaves nothing running."""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest

import glanz
from glanz.addon import accuracy, measurement
from glanz.cli import curve, curve_files
from glanz.tests.addon import blender

SAID = "glanz: cornell: 256x256\nglanz: 7% done\nglanz: 34% done\n"
SLEEPING = "import time; print('glanz: 34% done', flush=True); time.sleep(10)"


def rung(samples, seconds, rmse, is_best):
    return curve.Rung("path", "sobol", 8, samples, seconds, 0.1, rmse, rmse**2, None, rmse, 0.0, is_best=is_best)


@pytest.fixture
def children(monkeypatch):
    """The processes that are started, which are Python with the `script` in place of Glanz."""
    found, popen = [], subprocess.Popen

    def started(command, **options):
        found.append(popen([sys.executable, "-c", children.script, *command], **options))
        return found[-1]

    children = SimpleNamespace(script=SLEEPING, found=found)
    monkeypatch.setattr(measurement.subprocess, "Popen", started)
    monkeypatch.setattr(accuracy, "_SECONDS_BETWEEN_LOOKS", 0.01)
    yield children
    for child in found:
        child.kill()
        child.wait()


@pytest.fixture
def in_front(monkeypatch):
    """Blender with a window, whose timers the test is."""
    monkeypatch.setattr(
        accuracy.bpy, "app", SimpleNamespace(background=False, binary_path="", timers=bpy.app.timers, handlers=bpy.app.handlers)
    )


@pytest.fixture
def saved(tmp_path):
    blender.add_camera()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    return tmp_path


def wait_for(condition):
    end = time.monotonic() + 20
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def drawn():
    """The texts and buttons of the panel."""
    found = []

    class Layout:
        def label(self, text, **options):
            found.append(text)

        def progress(self, factor, text):
            found.append(text)

        def operator(self, idname, **options):
            found.append(idname)

        def column(self, **options):
            return self

        row = split = column

    context = SimpleNamespace(region=SimpleNamespace(width=2000), preferences=bpy.context.preferences)
    accuracy.GLANZ_RENDER_PT_accuracy.draw(SimpleNamespace(layout=Layout()), context)
    return found


def test_blender_measures_a_copy_in_a_blender_of_its_own(monkeypatch):
    words = ["bench", "/tmp/x/scene.blend", "-o", "/a/glanz_bench", "--scene=-S", "--view-layer=L"]
    monkeypatch.setattr(measurement.bpy, "app", SimpleNamespace(binary_path="/opt/blender"))
    asked = ("/tmp/x/scene.blend", "/a/glanz_bench", "-S", "L")
    assert measurement.command(*asked) == ["/opt/blender", "--addons", "glanz", "--command", "glanz", *words]
    monkeypatch.setattr(measurement.bpy, "app", SimpleNamespace(binary_path=""))
    assert measurement.command(*asked) == [sys.executable, "-m", "glanz.cli", *words]
    parsed = glanz.cli.arguments.parser("1").parse_args(words)
    assert (parsed.scene, parsed.view_layer, parsed.output) == ("-S", "L", "/a/glanz_bench")


def test_rows_are_the_pareto_front_of_the_table_by_time(tmp_path, monkeypatch):
    monkeypatch.setattr(curve_files, "_plot", lambda *_: False)
    rungs = [rung(16, 2.0, 0.1, True), rung(4, 3.0, 0.3, False), rung(1, 0.5, 0.4, True)]
    curve_files.write(tmp_path, rungs, {"scene": "S", "width": 1, "height": 1})
    assert measurement.read_rows(tmp_path / "curve.json") == (
        measurement.Row("path, sobol, 1 sample, depth 8", 0.5, 0.4, "noise"),
        measurement.Row("path, sobol, 16 samples, depth 8", 2.0, 0.1, "noise"),
    )


def test_progress_is_what_was_said_last():
    assert measurement.share_done("") == 0
    assert measurement.share_done(SAID) == 0.34


def test_the_problem_is_the_error_or_else_the_last_line():
    assert measurement.problem(f"{SAID}glanz: error: scene 'S' is black\n\nBlender quit\n", 1) == "scene 'S' is black"
    assert measurement.problem('Unrecognized command: "glanz"\n\nBlender quit\n', 1).endswith('status 1: Unrecognized command: "glanz"')
    assert measurement.problem("", -9) == "the process ended with status -9: it said nothing"


def test_it_measures_the_file_as_it_is_and_leaves_it_alone(saved, children):
    """The fake Glanz looks for an object that was never saved, and writes a table."""
    table = json.dumps({"rungs": [rung(16, 2.0, 0.1, True).as_dict()]})
    children.script = (
        "import sys, pathlib; words = sys.argv[1:]; copy = pathlib.Path(words[words.index('bench') + 1]);"
        "folder = pathlib.Path(words[words.index('-o') + 1]); folder.mkdir();"
        "(folder / 'copy.blend').write_bytes(copy.read_bytes());"
        f"(folder / 'curve.json').write_text({table!r}); print('glanz: warning: no matplotlib')"
    )
    before = (saved / "a.blend").read_bytes()
    bpy.context.scene.name = "Unsaved"
    assert bpy.ops.glanz.measure_accuracy() == {"FINISHED"}
    assert bpy.data.filepath == str(saved / "a.blend")
    assert (saved / "a.blend").read_bytes() == before
    assert drawn() == [
        "glanz.measure_accuracy",
        "a.blend, Unsaved",
        *("Best settings", "Time", "Error", "Error is"),
        *("path, sobol, 16 samples, depth 8", "2.00 s", "10.00 %", "noise"),
        "no matplotlib",
        f"All settings: {saved / 'glanz_bench'}",
    ]
    with bpy.data.libraries.load(str(saved / "glanz_bench" / "copy.blend")) as (found, _):
        assert found.scenes == ["Unsaved"]


def test_the_copy_finds_the_files_that_the_original_does(saved, children):
    image = bpy.data.images.new("T", 1, 1)
    image.source, image.filepath, image.use_fake_user = "FILE", "//t.png", True
    running = measurement.start(bpy.context.scene, bpy.context.view_layer)
    (command,) = (child.args for child in children.found)
    with bpy.data.libraries.load(command[command.index("bench") + 1], link=True) as (_, asked):
        asked.images = ["T"]
    running.end()
    (linked,) = (image for image in bpy.data.images if image.library)
    assert Path(bpy.path.abspath(linked.filepath, library=linked.library)).resolve() == saved / "t.png"
    assert image.filepath == "//t.png"


def test_a_failure_is_told(saved, children):
    children.script = "import sys; print('glanz: error: scene is black', file=sys.stderr); sys.exit(1)"
    with pytest.raises(RuntimeError, match="Measure Accuracy: scene is black"):
        bpy.ops.glanz.measure_accuracy()
    assert drawn() == ["glanz.measure_accuracy", "a.blend, Scene", "scene is black"]


def test_success_without_a_table_is_a_failure(saved, children):
    children.script = "print('Blender quit')"
    with pytest.raises(RuntimeError, match="there is no table in"):
        bpy.ops.glanz.measure_accuracy()


def test_where_nothing_can_be_written_nothing_is_started(saved, children, monkeypatch):
    monkeypatch.setattr(measurement.os, "access", lambda path, mode: False)
    with pytest.raises(RuntimeError, match=r"cannot write to .*glanz_bench"):
        bpy.ops.glanz.measure_accuracy()
    assert not children.found


def test_an_unsaved_file_is_measured_into_a_temporary_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    folder = measurement.output_folder()
    assert folder.parent == tmp_path and folder.is_dir()


@pytest.mark.parametrize("end", ["cancel", "disable"])
def test_cancelling_and_disabling_end_the_process(end, saved, children, in_front, monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    bpy.ops.glanz.measure_accuracy()
    (child,) = children.found
    wait_for(lambda: accuracy._look() and accuracy._state["running"].done)
    assert drawn() == ["a.blend, Scene", "34%", "glanz.cancel_measurement"]
    assert not accuracy.GLANZ_OT_measure_accuracy.poll(bpy.context)
    assert child.returncode is None and list(tmp_path.glob("glanz_bench_*/scene.blend"))
    if end == "cancel":
        bpy.ops.glanz.cancel_measurement()
        assert drawn() == ["glanz.measure_accuracy"]
    else:
        glanz.unregister()
    # It would have ended well, by itself.
    assert child.returncode not in (None, 0)
    assert [path.name for path in Path(tmp_path).iterdir()] == ["a.blend"]
    assert accuracy._look() is None
