"""What needs Blender, tested in every Blender that Glanz supports: `make test-matrix`.

Each version has an environment of its own, which the Makefile sets up. Output goes to out/matrix/. A version that fails
does not stop the others; the exit status is 0 only if all passed. A Python that is not the default one is looked for in
the path and in pyenv; PYTHON311 and PYTHON313 name them otherwise.
"""

import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "matrix"
VERSIONS = (("4.2", "3.11", "4.2.23"), ("4.5", "3.11", "4.5.15"), ("5.0", "3.11", ""), ("5.2", "3.13", ""))
"""(Blender, the Python that it exists for, its wheel; empty: the one of pyproject.toml)."""


def main():
    OUT.mkdir(parents=True, exist_ok=True)
    failed = [blender for blender, python, wheel in VERSIONS if not passes(blender, python, wheel)]
    print(f"failed: {', '.join(failed)}" if failed else "all passed")
    return bool(failed)


def passes(blender, python, wheel):
    """Whether the tests pass in one version, and a line that says so."""
    start = time.monotonic()
    environment = environment_for(python, wheel)
    if environment is None:
        print(f"Blender {blender}: FAILED: there is no Python {python}; name one, as in PYTHON{python.replace('.', '')}=/path/to/python")
        return False
    log = OUT / f"{blender}.log"
    with open(log, "wb") as output:
        # Its standard input is empty: nothing may ask.
        command = [os.environ.get("MAKE", "make"), "--no-print-directory", "test-addon"]
        result = subprocess.run(command, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
    summary = summary_of(log.read_text(errors="replace"))
    verdict = "passed" if result.returncode == 0 else f"FAILED, see {log.relative_to(ROOT)}"
    print(f"Blender {blender}: {verdict}: {summary}, {time.monotonic() - start:.0f} s", flush=True)
    return result.returncode == 0


def summary_of(text):
    """pytest's own last line, or whatever came last instead."""
    found = re.findall(r"^=* ?(\d+ (?:passed|failed|error|skipped)\b.*?) in [\d.]+s", text, re.MULTILINE)
    lines = text.strip().splitlines()
    return found[-1] if found else lines[-1] if lines else "no output"


def environment_for(python, wheel):
    """What make has to be told; None where there is no such Python."""
    inherited = {name: value for name, value in os.environ.items() if name not in ("PYTHON", "BPY", "MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    own = {"BPY": wheel} if wheel else {}
    # The default Python needs no name, and so has the environment that `make test` uses.
    if version_of("python3") == python:
        return inherited | own
    found = find_python(python)
    return inherited | own | {"PYTHON": found} if found else None


def find_python(version):
    """The path of a Python of this version that runs, or None. A bare python3.13 may be a shim of pyenv that refuses to."""
    for name in (os.environ.get(f"PYTHON{version.replace('.', '')}"), f"python{version}"):
        if name and version_of(name) == version:
            return shutil.which(name)
    if not shutil.which("pyenv"):
        return None
    listed = subprocess.run(["pyenv", "versions", "--bare"], capture_output=True, text=True).stdout.split()
    patches = [int(name.split(".")[2]) for name in listed if re.fullmatch(rf"{re.escape(version)}\.\d+", name)]
    for name in (f"{version}.{patch}" for patch in sorted(patches, reverse=True)):
        which = subprocess.run(
            ["pyenv", "which", f"python{version}"], env={**os.environ, "PYENV_VERSION": name}, capture_output=True, text=True
        )
        if version_of(which.stdout.strip()) == version:
            return which.stdout.strip()
    return None


def version_of(python):
    """Such as "3.13"; empty: it does not run."""
    if not python or not shutil.which(python):
        return ""
    program = "import sys; print('%d.%d' % sys.version_info[:2])"
    return subprocess.run([python, "-c", program], capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout.strip()


if __name__ == "__main__":
    sys.exit(main())
