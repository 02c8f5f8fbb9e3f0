"""Download the wheels that the extension bundles, unmodified, and check them against `wheels.sha256`.

Wheels that are there already are checked, not loaded again.
"""

import hashlib
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CHECKSUMS = ROOT / "tools" / "wheels.sha256"


def checksums(path=CHECKSUMS):
    """{file name: sha256 in hex} of a file in the format of sha256sum."""
    pairs = (line.split() for line in path.read_text().splitlines())
    return {name: digest for digest, name in pairs}


def fetch(names, folder, known):
    """Bring the wheels `names` into `folder`; exits, naming the wheel, when one cannot be had as `known` describes it."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        if name not in known:
            sys.exit(f"{name} is declared in blender_manifest.toml but not in {CHECKSUMS.relative_to(ROOT)}")
        wheel = folder / name
        if not wheel.exists():
            print(f"downloading {name}", flush=True)
            subprocess.run(download_command(name, folder), check=True, stdin=subprocess.DEVNULL)
        if not wheel.exists():
            sys.exit(f"the package index gave another file than {name}")
        if hashlib.sha256(wheel.read_bytes()).hexdigest() != known[name]:
            wheel.unlink()
            sys.exit(f"{name} is not the file that {CHECKSUMS.relative_to(ROOT)} describes; it was removed")


def download_command(name, folder):
    """The pip command for exactly the wheel `name`: project-version-python-abi-platforms.whl."""
    project, version, python, abi, platforms = name.removesuffix(".whl").split("-")
    where = [option for platform in platforms.split(".") for option in ("--platform", platform)]
    target = [*where, "--implementation", "cp", "--python-version", python.removeprefix("cp"), "--abi", abi]
    options = ["--quiet", "--no-deps", "--only-binary=:all:", "--dest", str(folder)]
    return [sys.executable, "-m", "pip", "download", *options, *target, f"{project}=={version}"]
