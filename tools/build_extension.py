"""Build the extension for Blender: `build_extension.py [platform ...]`, all of the manifest's platforms if none is given.

Only the files that belong into the extension are gathered under build/extension, then Blender's own builder, which
comes with the `bpy` wheel, makes and checks the zips in dist/.
"""

import importlib.util
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

from fetch_wheels import ROOT, checksums, fetch

FILES = ("__init__.py", "LICENSE", "README.md")
FOLDERS = ("addon", "cli", "engine", "LICENSES")
TAGS = {"linux-x64": ("manylinux", "x86_64"), "windows-x64": ("win", "amd64"), "macos-arm64": ("macosx", "arm64")}
"""How the platform tag of a wheel for each platform begins and ends."""


def main(platforms):
    declared = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    platforms = platforms or declared["platforms"]
    if unknown := set(platforms) - set(declared["platforms"]):
        sys.exit(f"unknown platform {', '.join(unknown)}; known: {', '.join(declared['platforms'])}")
    wheels = [wheel for wheel in declared["wheels"] if is_for(wheel, platforms)]
    fetch([Path(wheel).name for wheel in wheels], ROOT / "wheels", checksums())
    staging, dist = ROOT / "build" / "extension", ROOT / "dist"
    stage(ROOT, staging, platforms, ROOT / "wheels")
    dist.mkdir(exist_ok=True)
    for old in dist.glob(f"{declared['id']}-*.zip"):
        old.unlink()
    zips = build(staging, dist)
    for path in zips:
        print(f"{path.relative_to(ROOT)}  {path.stat().st_size / 1e6:.1f} MB")


def is_for(wheel, platforms):
    """Whether the wheel `wheel`, a path, runs on one of the `platforms`."""
    tag = wheel.removesuffix(".whl").rsplit("-", 1)[1]
    return any(tag.startswith(TAGS[platform][0]) and tag.endswith(TAGS[platform][1]) for platform in platforms)


def stage(root, staging, platforms, wheels):
    """Gather the extension for `platforms` in the empty folder `staging`, with wheels from the folder `wheels`."""
    shutil.rmtree(staging, ignore_errors=True)
    (staging / "wheels").mkdir(parents=True)
    for name in FILES:
        shutil.copy2(root / name, staging / name)
    for name in FOLDERS:
        shutil.copytree(root / name, staging / name, ignore=shutil.ignore_patterns("__pycache__", ".*", "*.pyc"))
    manifest = manifest_for((root / "blender_manifest.toml").read_text(), platforms)
    (staging / "blender_manifest.toml").write_text(manifest)
    for wheel in tomllib.loads(manifest)["wheels"]:
        source = wheels / Path(wheel).name
        try:
            (staging / wheel).hardlink_to(source)
        except OSError:  # another file system
            shutil.copy2(source, staging / wheel)


def manifest_for(text, platforms):
    """The manifest `text` with nothing in it but what concerns `platforms`."""
    listed = ", ".join(f'"{platform}"' for platform in platforms)
    lines = re.sub(r"^platforms = .*$", f"platforms = [{listed}]", text, flags=re.MULTILINE).splitlines(keepends=True)
    return "".join(line for line in lines if ".whl" not in line or is_for(line.strip(' ",\n'), platforms))


def build(staging, output):
    """Zips of the staged extension, one for each platform, made and validated by Blender's builder; their paths."""
    builder = find_builder()
    before = set(output.glob("*.zip"))
    run(builder, "validate", str(staging))
    run(builder, "build", "--split-platforms", "--source-dir", str(staging), "--output-dir", str(output))
    zips = sorted(set(output.glob("*.zip")) - before)
    for path in zips:
        run(builder, "validate", str(path))
    return zips


def find_builder():
    """The path of `blender_ext.py` in the installed `bpy`, found without loading Blender."""
    spec = importlib.util.find_spec("bpy")
    folders = spec.submodule_search_locations if spec else ()
    found = [path for folder in folders for path in Path(folder).glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py")]
    if not found:
        sys.exit("Blender's extension builder comes with the Python package bpy, which is not installed (Python 3.11 and 3.13 have it)")
    return found[0]


def run(builder, *arguments):
    result = subprocess.run([sys.executable, str(builder), *arguments], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if result.returncode:
        sys.exit(f"blender_ext {arguments[0]} failed:\n{result.stdout}{result.stderr}")


if __name__ == "__main__":
    main(sys.argv[1:])
