"""The command line on scene files: no Blender is there, pictures and exit status are true."""

import dataclasses
import json
import os
import subprocess
import sys

import numpy as np
import pytest

from glanz.cli import main
from glanz.cli.window import fitted
from glanz.engine import PanoramaCamera, PerspectiveCamera, Settings, render_image, write_scene
from glanz.engine.io.exr import read_exr, read_exr_metadata
from glanz.tests import helpers

SETTINGS = helpers.settings(width=12, height=8, passes=("Combined", "Depth"))


def a_scene():
    floor = helpers.quad((0, 0, -0.5), (8, 0, 0), (0, 8, 0), name="floor")
    return helpers.scene([helpers.thing(helpers.box()), helpers.thing(floor)], world=0.5)


@pytest.fixture
def scene_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_scene("scene.glanz", a_scene(), SETTINGS)
    return "scene.glanz"


def expected(settings, scene=None):
    return render_image(scene or a_scene(), settings).passes["Combined"]


def combined(path):
    channels = read_exr(path)
    return np.stack([channels[c] for c in "RGBA"], axis=-1)


def test_a_scene_file_renders_to_the_picture_of_the_engine(scene_file, capsys):
    assert main(["render", scene_file, "-o", "a.exr", "-o", "a.png"]) == 0
    assert capsys.readouterr().out == "wrote a.exr\nwrote a.png\n"
    assert helpers.same_bits(combined("a.exr"), expected(SETTINGS))
    assert "Depth.Z" in read_exr("a.exr")
    assert read_exr_metadata("a.exr")["glanz.version"] == "0.1.0"


def test_without_an_output_the_picture_is_named_after_the_file(scene_file, tmp_path, capsys):
    assert main(["render", scene_file]) == 0
    assert capsys.readouterr().out == "wrote scene.exr\n"
    assert (tmp_path / "scene.exr").exists()


CHANGES = {
    "--samples 2": {"samples": 2},
    "--max-depth 0": {"max_depth": 0},
    "--seed 9": {"seed": 9},
    "--sampler random": {"sampler": "random"},
    "--pixel-filter blackman_harris": {"pixel_filter": "blackman_harris"},
    "--border 0.25,0,0.75,0.5": {"border": (3, 4, 9, 8)},
}


@pytest.mark.parametrize("words", CHANGES)
def test_what_the_command_line_says_holds_instead_of_the_file(scene_file, words):
    assert main(["render", scene_file, "-o", "a.exr", *words.split()]) == 0
    wanted = expected(dataclasses.replace(SETTINGS, **CHANGES[words]))
    assert helpers.same_bits(combined("a.exr"), wanted)
    assert not helpers.same_bits(wanted, expected(SETTINGS))


def test_resolution_changes_the_frame_and_keeps_the_view_of_the_longer_side(scene_file):
    assert main(["render", scene_file, "-o", "a.exr", "--resolution", "6x8"]) == 0
    scene = fitted(a_scene(), (12, 8), (6, 8))
    assert helpers.same_bits(combined("a.exr"), expected(dataclasses.replace(SETTINGS, width=6, height=8), scene))


@pytest.mark.parametrize(
    ("old", "new", "window"),
    [
        ((200, 100), (400, 200), (-1, 1.5, -0.5, 0.75)),
        ((200, 100), (100, 100), (-1, 1.5, -1.125, 1.375)),
        ((200, 100), (100, 200), (-0.375, 0.875, -1.125, 1.375)),
        ((200, 50), (100, 100), (-0.375, 0.875, -1.125, 1.375)),  # pixels twice as high as wide
    ],
)
def test_the_window_follows_the_frame_as_blenders_automatic_sensor_fit(old, new, window):
    scene = helpers.scene(camera=PerspectiveCamera(window=(-1, 1.5, -0.5, 0.75)))
    np.testing.assert_allclose(fitted(scene, old, new).camera.window, window, rtol=1e-12)


def test_a_panorama_fills_a_frame_of_any_shape():
    scene = helpers.scene(camera=PanoramaCamera())
    assert fitted(scene, (200, 100), (100, 100)) is scene


FAILURES = {
    "render nowhere.glanz": "'nowhere.glanz': file not found",
    "render nowhere.blend": "'nowhere.blend': file not found",
    "render .": "not a regular file",
    "render text": "not a Glanz scene",
    "render scene.glanz -o nowhere/a.exr": "cannot write 'nowhere/a.exr'",
    "render scene.glanz -o folder.exr": "cannot write 'folder.exr': it is a folder",
    "render scene.glanz --frame 1": "holds one frame",
    "render scene.glanz --frames 1-2": "holds one frame",
    "render scene.glanz --scene Nope": "no scene 'Nope'",
    "render scene.glanz --samples 0": "samples is 0",
    "render scene.glanz --integrator magic": "unknown integrator 'magic'",
    "render blind.glanz": "no camera",
    "info blind.glanz": "no camera",
    "info nowhere.glanz": "file not found",
    "export scene.glanz -o nowhere/b": "cannot write 'nowhere/b'",
}


@pytest.mark.parametrize("words", FAILURES)
def test_a_failure_is_named_in_one_line_with_status_1_and_leaves_no_file(scene_file, tmp_path, capsys, words):
    (tmp_path / "text").write_text("no scene")
    (tmp_path / "folder.exr").mkdir()
    write_scene("blind.glanz", dataclasses.replace(a_scene(), camera=None), SETTINGS)
    before = sorted(tmp_path.iterdir())
    assert main([*words.split(), *(["--quiet"] if words.startswith("render") else [])]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("glanz: error: ")
    assert FAILURES[words] in err
    assert err.count("\n") == 1
    assert sorted(tmp_path.iterdir()) == before


def test_a_warning_is_said_once_on_stderr(scene_file, capsys):
    lost = helpers.thing(helpers.box(name="lost"), matrix=np.full((4, 4), np.nan))
    write_scene("warns.glanz", dataclasses.replace(a_scene(), objects=(lost,)), SETTINGS)
    assert main(["render", "warns.glanz", "--quiet"]) == 0
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err == "glanz: warning: the transform is not finite, so it is left out: object 'lost'\n"
    assert main(["render", "warns.glanz", "--quiet", "--strict", "-o", "strict.exr"]) == 1
    assert "glanz: error: scene 'Scene' is strict" in capsys.readouterr().err
    assert not os.path.exists("strict.exr")
    assert main(["info", "warns.glanz", "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    what = "the transform is not finite, so it is left out"
    assert content["notes"] == [{"what": what, "kind": "ignored", "datablock": "object", "name": "lost", "node": []}]
    assert content["warnings"] == [f"{what}: object 'lost'"]


def test_info_says_who_asked_for_what(scene_file, capsys):
    assert main(["info", scene_file]) == 0
    text = capsys.readouterr().out
    assert "geometry" in text
    assert "nothing is approximated or ignored" in text
    assert main(["info", scene_file, "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["requirements"]["geometry"] == ["box", "floor"]
    assert content["settings"]["width"] == 12
    assert content["counts"] == {"objects": 2, "triangles": 14, "lights": 0, "warnings": 0}
    assert content["warnings"] == content["notes"] == []


def without_bpy(*words):
    program = "import sys; sys.modules['bpy'] = None; from glanz.cli import main; sys.exit(main(sys.argv[1:]))"
    return subprocess.run([sys.executable, "-c", program, *words], capture_output=True, text=True, check=False)


def test_nothing_of_blender_is_loaded_for_a_scene_file(scene_file):
    result = without_bpy("render", scene_file, "-o", "a.exr")
    assert result.returncode == 0, result.stderr
    assert helpers.same_bits(combined("a.exr"), expected(SETTINGS))


def test_a_blend_file_without_bpy_is_an_error_with_the_cure(scene_file, tmp_path):
    (tmp_path / "a.blend").write_bytes(b"BLENDER")
    result = without_bpy("render", "a.blend")
    assert result.returncode == 1
    assert "pip install" in result.stderr


def test_bugs_are_told_apart_from_mistakes(scene_file, capsys, monkeypatch):
    monkeypatch.setattr("glanz.cli.commands.render_image", lambda *a: 1 / 0)
    assert main(["render", scene_file]) == 1
    err = capsys.readouterr().err
    assert "Traceback" in err
    assert "glanz: error: unexpected ZeroDivisionError" in err.splitlines()[-1]


def test_the_default_settings_survive_the_command_line(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_scene("a.glanz", a_scene(), Settings(width=2, height=2))
    assert main(["info", "a.glanz", "--json"]) == 0
    settings = json.loads(capsys.readouterr().out)["settings"]
    wanted = dataclasses.asdict(Settings(width=2, height=2))
    assert settings == json.loads(json.dumps(wanted))


@pytest.mark.parametrize(("redirection", "status"), [("> /dev/full", 1), (">&-", 0)])
def test_an_answer_that_nobody_gets_is_no_traceback(scene_file, redirection, status):
    command = f"{sys.executable} -m glanz.cli info {scene_file} {redirection}"
    result = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert result.returncode == status
    assert "Traceback" not in result.stderr


def test_an_answer_into_a_closed_pipe_is_no_traceback(scene_file):
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-m", "glanz.cli", "info", scene_file]
    result = subprocess.run(command, stdout=writing, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writing)
    assert (result.returncode, result.stderr) == (1, "")
