"""Runs Glanz in a real Blender with a window: `run.py [SCRIPT ...]`, all scripts of this folder if none is named;
`run.py --platform` says which platform's extension it needs.

    BLENDER=/path/to/blender make desktop-test

The extension's zip is installed as a user would, into user folders of its own that are removed afterwards; then each
script runs in a Blender of its own (harness.py). What it printed and the pictures of its screen stay in out/desktop/.
A script fails when it says so, when Blender crashes or prints a traceback or an error, and when its time is up.

GLANZ_ZIP: the zip, the newest in dist/ if not given. The exit status is 0 only if everything passed.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
OUT = ROOT / "out" / "desktop"
SCRIPTS = sorted(path.stem for path in FOLDER.glob("*.py") if path.stem not in ("harness", "run", "screen", "symbols", "views"))
PATIENCE = 150.0
"""Seconds for one script, start of Blender included."""
PLATFORM = {"linux": "linux-x64", "win32": "windows-x64", "darwin": "macos-arm64"}.get(sys.platform, sys.platform)
"""As blender_manifest.toml names it."""
BAD = re.compile(r"Traceback \(most recent|^Error:|\bERROR\b|rna_uiItem|uiItem\w+:|Segmentation fault")
"""What Blender prints when something of an add-on goes wrong, often without any other sign of it."""


class Failure(Exception):
    """Ends the run with a message rather than with a traceback."""


def main(names):
    if unknown := set(names) - set(SCRIPTS):
        raise Failure(f"unknown script {', '.join(sorted(unknown))}; known: {', '.join(SCRIPTS)}")
    blender, archive = find_blender(), find_zip()
    check_display()
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    with user_folders() as environment:
        environment["GLANZ_ZIP"] = str(archive)
        print(f"{version_of(blender, environment)}, {archive.name}", flush=True)
        verdicts = {"installation": install(blender, archive, environment)}
        if not verdicts["installation"]:
            for name in names or SCRIPTS:
                verdicts[name] = run_script(blender, name, environment)
            verdicts["removal"] = remove(blender, environment)
    failed = [name for name, complaint in verdicts.items() if complaint]
    names_of_failed = f": {', '.join(failed)}" if failed else ""
    print(f"{len(verdicts) - len(failed)} passed, {len(failed)} failed{names_of_failed}; see {OUT.relative_to(ROOT)}/")
    return bool(failed)


def find_blender():
    """The executable that BLENDER names, else `blender` of the path."""
    wish = os.environ.get("BLENDER") or "blender"
    found = shutil.which(wish)
    if not found:
        raise Failure(f"there is no Blender at '{wish}': name its executable, as in BLENDER=/path/to/blender make desktop-test")
    return found


def find_zip():
    """The extension for this system."""
    if wish := os.environ.get("GLANZ_ZIP"):
        found = [Path(wish).resolve()] if Path(wish).is_file() else []
    else:
        found = sorted((ROOT / "dist").glob(f"glanz-*-{PLATFORM.replace('-', '_')}.zip"), key=lambda path: path.stat().st_mtime)
    if not found:
        raise Failure("there is no zip of the extension: make extension, or name one, as in GLANZ_ZIP=dist/glanz.zip")
    return found[-1]


def check_display():
    """Without a display Blender ends with an error that says little."""
    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        raise Failure(
            "a window needs an X11 display, and DISPLAY is not set: run this from a desktop (Wayland's have X11 too), or give it a "
            "virtual screen, as in xvfb-run -s '-screen 0 1600x1000x24' make desktop-test"
        )


@contextmanager
def user_folders():
    """The environment of a user who has started no Blender yet."""
    with tempfile.TemporaryDirectory(prefix="glanz-desktop-", ignore_cleanup_errors=True) as folder:
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("BLENDER_", "PYTHON"))}
        # Natively on Wayland Blender gives no pictures of its windows.
        environment.pop("WAYLAND_DISPLAY", None)
        resources = Path(folder, "resources")
        resources.mkdir()
        yield environment | {"BLENDER_USER_RESOURCES": str(resources), "TMPDIR": folder}


def version_of(blender, environment):
    """Such as "Blender 5.2.2 LTS"."""
    result = subprocess.run([blender, "--version"], env=environment, capture_output=True, text=True, timeout=PATIENCE)
    if result.returncode:
        raise Failure(f"'{blender}' does not run: {(result.stderr or result.stdout).strip()}")
    return result.stdout.splitlines()[0]


def install(blender, archive, environment):
    """What is wrong with installing and enabling the zip; empty: nothing."""
    command = [blender, "--command", "extension", "install-file", "-r", "user_default", "--enable", str(archive)]
    return judge("installation", command, environment)


def remove(blender, environment):
    """What is wrong with removing Glanz again, and with a start of Blender without it."""
    complaint = judge("removal", [blender, "--command", "extension", "remove", "glanz"], environment)
    left = [path for path in Path(environment["BLENDER_USER_RESOURCES"]).rglob("*") if re.search("glanz|embreex|openexr", path.name, re.I)]
    if left and not complaint:
        complaint = f"left behind: {', '.join(map(str, left))}"
        print(f"removal: FAILED: {complaint}")
    return complaint


def run_script(blender, name, environment):
    """What is wrong with a script; empty: nothing."""
    folder = OUT / name
    folder.mkdir()
    command = [blender, "-noaudio", "--window-geometry", "0", "0", "1600", "1000"]
    if sys.platform.startswith("linux"):
        command += ["--gpu-backend", "opengl"]
    command += ["--python", str(FOLDER / "harness.py"), "--", str(FOLDER / f"{name}.py"), str(folder)]
    return judge(name, command, environment, verdict=folder / "verdict")


def judge(name, command, environment, verdict=None):
    """Run a command, keep what it prints in OUT/NAME.log, and say in one line how it went; returns what is wrong."""
    start = time.monotonic()
    log = OUT / f"{name}.log"
    with open(log, "wb") as output:
        process = subprocess.Popen(
            command, env=environment, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, start_new_session=True
        )
        try:
            status = process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            status = None
            end(process)
    text = log.read_text(errors="replace")
    complaint = fault(status, text, verdict)
    for line in text.splitlines():
        if line.startswith("measured: "):
            print(f"    {line.removeprefix('measured: ')}")
    print(f"{name}: {f'FAILED: {complaint}' if complaint else 'passed'}, {time.monotonic() - start:.0f} s", flush=True)
    if complaint:
        print("".join(f"    | {line}\n" for line in text.splitlines()[-25:]), flush=True)
    return complaint


def fault(status, text, verdict):
    """What is wrong with a process by its exit status (None: it was ended), its output and its script's verdict file."""
    if status is None:
        return f"not done after {PATIENCE:.0f} s"
    if status < 0:
        return f"Blender crashed: {signal.Signals(-status).name}"
    expected = re.findall(r"^expected: (.*)", text, re.MULTILINE)
    for line in text.splitlines():
        if BAD.search(line) and not any(part in line for part in expected):
            return f"Blender printed: {line}"
    if verdict and not verdict.exists():
        return f"Blender ended before the script did, exit status {status}"
    if verdict and verdict.read_text().strip() != "0":
        return "the script failed"
    return f"exit status {status}" if status else ""


def end(process):
    """End a process that has no time left, and all that it started."""
    if hasattr(os, "killpg"):
        os.killpg(process.pid, signal.SIGKILL)
    else:
        process.kill()
    process.wait()


if __name__ == "__main__":
    # Also as a script of Blender's, whose own arguments end with "--".
    words = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    try:
        if words == ["--platform"]:
            # Asked before the zip is built, which takes a while, and needs neither.
            find_blender()
            check_display()
            sys.exit(print(PLATFORM))
        sys.exit(main(words))
    except Failure as failure:
        sys.exit(f"desktop-test: {failure}")
