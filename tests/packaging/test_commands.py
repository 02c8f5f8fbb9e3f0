"""`make` and CI: a failed set-up is not taken for a good one, and a failed test run not for a passed one."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def script(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


def run(*command, cwd, **environment):
    inherited = {name: value for name, value in os.environ.items() if name not in ("PYTHON", "BPY", "MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    return subprocess.run(command, cwd=cwd, env=inherited | environment, capture_output=True, text=True, check=False)


@pytest.fixture
def project(tmp_path):
    for name in ("Makefile", "pyproject.toml", "tools/check_bpy.py", ".ci/run"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy2(ROOT / name, tmp_path / name)
    return tmp_path


def test_a_python_that_does_not_run_is_named(project):
    result = run("make", "test", cwd=project, PYTHON="python9.9")
    assert result.returncode != 0
    assert "'python9.9' does not run" in result.stderr


def test_a_python_that_is_too_old_is_named(project):
    old = script(project / "old", 'case "$2" in *print*) echo 3.9;; *) exit 1;; esac')
    result = run("make", "test", cwd=project, PYTHON=str(old))
    assert result.returncode != 0
    assert "Python 3.9 is too old" in result.stderr


def test_a_failed_set_up_leaves_no_stamp(project):
    # An environment whose pip fails: the set-up gets as far as installing.
    python = script(
        project / "fake",
        f"""case "$*" in
        "-m venv"*) mkdir -p "$4/bin"; cp "$0" "$4/bin/python"; exit 0;;
        *"pip install"*) echo no network >&2; exit 1;;
        *) exec {sys.executable} "$@";;
        esac""",
    )
    result = run("make", "test", cwd=project, PYTHON=str(python))
    assert result.returncode != 0
    assert "no network" in result.stderr
    assert not list(project.glob(".venv*/.ready*"))


@pytest.mark.parametrize(
    ("environment", "folder"),
    [
        ({}, ".venv"),
        ({"PYTHON": sys.executable}, ".venv-{}.{}".format(*sys.version_info)),
        ({"PYTHON": sys.executable, "BPY": "4.2.23"}, ".venv-{}.{}-bpy-4.2.23".format(*sys.version_info)),
        ({"BPY": "none"}, ".venv-bpy-none"),
    ],
)
def test_every_interpreter_and_blender_has_an_environment_of_its_own(project, environment, folder):
    result = run("make", "--dry-run", "test", cwd=project, **environment)
    assert f"\n{folder}/bin/python -m pytest" in result.stdout
    assert ("bpy==4.2.23" in result.stdout) == ("4.2.23" in environment.get("BPY", ""))
    assert ("blender]" in result.stdout) == ("BPY" not in environment)


def ci(project, make, **environment):
    """`.ci/run` with a stand-in for make, and no other Python but those in bin/."""
    script(project / "bin" / "make", f'echo "made with ${{PYTHON:-default}}"\n{make}')
    script(project / "bin" / "python3", "echo 3.11")
    for name in ("bash", "dirname", "grep", "tail", "env", "sh"):
        (project / "bin" / name).symlink_to(shutil.which(name))
    return run("bash", ".ci/run", cwd=project, PATH=str(project / "bin"), **environment)


def test_ci_fails_when_the_tests_do(project):
    assert ci(project, "exit 2").returncode != 0


def test_ci_passes_on_one_python_where_there_is_no_other(project):
    result = ci(project, "exit 0")
    assert result.returncode == 0
    assert result.stdout.count("made with") == 1


def test_ci_tests_on_python_3_13_too_and_fails_with_it(project):
    newer = script(project / "bin" / "python3.13", "echo 3.13")
    result = ci(project, '[ -z "$PYTHON" ]')
    assert result.returncode != 0
    assert f"made with default\n== PYTHON={newer} make test\nmade with {newer}" in result.stdout


def test_ci_finds_a_python_3_13_behind_a_shim_of_pyenv(project):
    script(project / "bin" / "python3.13", "exit 127")
    versions = 'printf "3.11.7\\n3.13.0\\n3.13.2\\n"'
    script(project / "bin" / "pyenv", f'if [ "$1" = versions ]; then {versions}; else echo "/pyenv/$PYENV_VERSION"; fi')
    assert "made with /pyenv/3.13.2" in ci(project, "exit 0").stdout


@pytest.fixture
def check_bpy():
    spec = importlib.util.spec_from_file_location("check_bpy", ROOT / "tools" / "check_bpy.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_missing_libraries_are_named_by_their_debian_packages(check_bpy):
    ldd = "\tlibm.so.6 => /lib/libm.so.6 (0x1)\n\tlibXi.so.6 => not found\n\tlibSM.so.6 => not found\n\tlibodd.so.1 => not found\n"
    text = check_bpy.advice("ImportError: libXi.so.6", check_bpy.missing_libraries(ldd))
    assert "sudo apt-get install libsm6 libxi6\n" in text
    assert "libodd.so.1" in text
