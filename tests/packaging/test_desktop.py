"""`tests/desktop/run.py` takes nothing for passed that was not: judged with stand-ins for Blender."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HARNESS = """#!/bin/sh
for last; do :; done
case "$*" in
--version) echo Blender 9.9.9;;
*extension*) {extension};;
*) {script};;
esac
"""
PASSED = 'echo 0 > "$last/verdict"'


@pytest.fixture
def desktop(tmp_path):
    """Runs two scripts of a folder of its own with a stand-in for Blender: (exit status, what was printed)."""
    folder = tmp_path / "glanz" / "tests" / "desktop"
    folder.mkdir(parents=True)
    (folder / "run.py").write_bytes((ROOT / "tests" / "desktop" / "run.py").read_bytes())
    for name in ("first", "second"):
        (folder / f"{name}.py").touch()
    (tmp_path / "glanz.zip").touch()

    def run(*names, extension="true", script=PASSED, **changed):
        blender = tmp_path / "blender"
        blender.write_text(HARNESS.format(extension=extension, script=script))
        blender.chmod(0o755)
        environment = {"PATH": os.environ["PATH"], "BLENDER": str(blender), "GLANZ_ZIP": str(tmp_path / "glanz.zip"), "DISPLAY": ":7"}
        command = [sys.executable, str(folder / "run.py"), *names]
        done = subprocess.run(command, env=environment | changed, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    return run


def test_scripts_that_pass_are_passed(desktop):
    status, text = desktop()
    assert status == 0
    assert "Blender 9.9.9, glanz.zip" in text
    assert "4 passed, 0 failed" in text
    assert "first: passed" in text and "second: passed" in text


@pytest.mark.parametrize(
    ("script", "complaint"),
    [
        ('echo 1 > "$last/verdict"', "the script failed"),
        ("exit 0", "Blender ended before the script did"),
        ("kill -SEGV $$", "Blender crashed: SIGSEGV"),
        (f"{PASSED}; exit 3", "exit status 3"),
        (f'{PASSED}; echo "Traceback (most recent call last):" >&2', "Blender printed: Traceback"),
        (f'{PASSED}; echo "rna_uiItemR: property not found: Scene.nonsense"', "Blender printed: rna_uiItemR"),
        (f'{PASSED}; echo "Error: Glanz cannot render"', "Blender printed: Error: Glanz"),
    ],
)
def test_whatever_goes_wrong_in_a_script_is_a_failure_and_the_others_still_run(desktop, script, complaint):
    status, text = desktop(script=f'case "$*" in *first.py*) {script};; *) {PASSED};; esac')
    assert status != 0
    assert f"first: FAILED: {complaint}" in text
    assert "second: passed" in text and "1 failed: first" in text


def test_an_error_that_a_script_expects_is_none(desktop):
    status, _ = desktop(script=f'{PASSED}; echo "expected: cannot render"; echo "Error: Glanz cannot render"')
    assert status == 0
    status, _ = desktop(script=f'{PASSED}; echo "expected: cannot render"; echo "Error: something else"')
    assert status != 0


def test_without_an_installation_nothing_else_is_tried(desktop):
    status, text = desktop(extension="echo 'Traceback (most recent call last):'")
    assert status != 0
    assert "installation: FAILED" in text and "first" not in text


def test_what_a_removal_leaves_behind_is_a_failure(desktop):
    status, text = desktop(extension='mkdir -p "$BLENDER_USER_RESOURCES/extensions/user_default/glanz"')
    assert status != 0
    assert "removal: FAILED: left behind" in text


@pytest.mark.parametrize(
    ("changed", "cure"),
    [
        ({"DISPLAY": ""}, "xvfb-run"),
        ({"BLENDER": "/nowhere/blender"}, "BLENDER=/path/to/blender"),
        ({"GLANZ_ZIP": "/nowhere.zip"}, "make extension"),
    ],
    ids=lambda value: "".join(value),
)
def test_what_is_missing_is_named_with_the_cure(desktop, changed, cure):
    status, text = desktop(**changed)
    assert status != 0
    assert cure in text and "Traceback" not in text


def test_a_script_that_there_is_not_is_named(desktop):
    status, text = desktop("third")
    assert status != 0
    assert "unknown script third; known: first, second" in text
