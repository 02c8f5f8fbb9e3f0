"""`make test-matrix` goes on after a failure, says how each version fared, and its exit status is the truth."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def script(path, text):
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


@pytest.fixture
def matrix(tmp_path):
    """Runs it with a stand-in for make, and Pythons of our choice: (exit status, lines)."""
    (tmp_path / "tools").mkdir()
    (tmp_path / "bin").mkdir()
    (tmp_path / "tools" / "test_matrix.py").write_bytes((ROOT / "tools" / "test_matrix.py").read_bytes())

    def run(make, **pythons):
        for name, version in pythons.items():
            script(tmp_path / "bin" / name.replace("_", "."), f"echo {version}")
        script(tmp_path / "bin" / "make", f'echo "== 5 passed in 2.5s (0:00:02) =="\n{make}')
        result = subprocess.run(
            [sys.executable, str(tmp_path / "tools" / "test_matrix.py")],
            env={"PATH": str(tmp_path / "bin")},
            capture_output=True,
            text=True,
            check=False,
        )
        return result.returncode, result.stdout.splitlines()

    return run


def test_every_version_is_tested_in_its_own_environment(matrix):
    status, lines = matrix('test "$1 $2" = "--no-print-directory test-addon"', python3="3.11", python3_13="3.13")
    assert status == 0
    assert [line.partition(":")[0] for line in lines] == ["Blender 4.2", "Blender 4.5", "Blender 5.0", "Blender 5.2", "all passed"]
    assert all(": passed: 5 passed, " in line for line in lines[:-1])


@pytest.mark.parametrize(
    ("failing", "blender"),
    [('"$BPY" = 4.2.23', "4.2"), ('"$BPY" = 4.5.15', "4.5"), ('-z "$BPY$PYTHON"', "5.0"), ('-n "$PYTHON"', "5.2")],
)
def test_a_version_that_fails_is_named_and_the_others_still_run(matrix, failing, blender):
    status, lines = matrix(f"if [ {failing} ]; then exit 2; fi", python3="3.11", python3_13="3.13")
    assert status != 0
    assert lines[-1] == f"failed: {blender}"
    assert sum(": passed:" in line for line in lines) == 3


def test_a_python_that_is_missing_is_a_failure_with_the_cure(matrix):
    status, lines = matrix("true", python3="3.11")
    assert status != 0
    assert lines[-1] == "failed: 5.2"
    assert "PYTHON313=/path/to/python" in lines[-2]


def test_the_default_python_may_be_the_newer_one(matrix):
    status, lines = matrix('test -n "$PYTHON" || test -z "$BPY"', python3="3.13", python3_11="3.11")
    assert status == 0, lines
    assert os.linesep.join(lines).count(": passed:") == 4
