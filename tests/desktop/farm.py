"""Blender without a window, as render farms start it: settings behind `--`, a status that tells the truth, and the program's command."""

import subprocess

import bpy
import harness as ui

SCENE = str(ui.ROOT / "sample_scenes" / "cornell_box.blend")
FRAME = ("-b", SCENE, "--python-exit-code", "3", "-E", "GLANZ", "-o", str(ui.out / "####"), "-F", "OPEN_EXR", "-f", "1", "--")


def main():
    done = blender(*FRAME, "--glanz-samples", "2")
    assert "of 2 samples" in done.stdout, done.stdout
    assert done.returncode == 0
    assert (ui.out / "0001.exr").stat().st_size > 0
    yield 0
    failed = blender(*FRAME, "--glanz-sampels", "2")
    assert "--glanz-sampels is no setting of Glanz" in failed.stdout, failed.stdout
    assert failed.returncode == 3
    yield 0
    told = blender("--command", "glanz", "info", SCENE)
    assert "bsdf lambert" in told.stdout, told.stdout + told.stderr
    assert told.returncode == 0
    yield 0
    picture = ui.out / "picture.exr"
    rendered = blender("--command", "glanz", "render", SCENE, "-o", str(picture), "--samples", "1", "--resolution", "32x32")
    assert rendered.returncode == 0, rendered.stderr
    assert picture.stat().st_size > 0


def blender(*words):
    return subprocess.run([bpy.app.binary_path, *words], capture_output=True, text=True, timeout=60)
