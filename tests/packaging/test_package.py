"""What the package says of itself is true, and said the same everywhere."""

import re
import tomllib
from pathlib import Path

import pytest

from glanz import engine
from glanz.cli.main import VERSION

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
WHEELS = [Path(wheel).name for wheel in MANIFEST["wheels"]]


def test_every_folder_with_code_is_in_the_package():
    files = [path for part in ("addon", "cli", "engine") for path in (ROOT / part).rglob("*.py")]
    folders = {"glanz", *(".".join(("glanz", *path.parent.relative_to(ROOT).parts)) for path in files)}
    assert set(PROJECT["tool"]["setuptools"]["packages"]) == folders


def test_what_others_have_licensed_is_packed_with_its_notice():
    data = {path for path in (ROOT / "engine").rglob("*") if path.is_file() and path.suffix not in (".py", ".pyc")}
    patterns = PROJECT["tool"]["setuptools"]["package-data"]
    assert data == {path for package, globs in patterns.items() for glob in globs for path in _folder(package).glob(glob)}
    licences = {path.stem for path in (ROOT / "LICENSES").glob("*.txt")}
    assert {licence.removeprefix("SPDX:") for licence in MANIFEST["license"]} == {"GPL-3.0-or-later", *licences}
    assert set(PROJECT["project"]["license"].split(" AND ")) == {"GPL-3.0-or-later", *licences}
    assert "LICENSES/*.txt" in PROJECT["project"]["license-files"]
    assert all(f"LICENSES/{licence}.txt" in (ROOT / "README.md").read_text(encoding="utf-8") for licence in licences)


def _folder(package):
    return ROOT.joinpath(*package.split(".")[1:])


def test_the_version_is_the_same_everywhere():
    latest = re.search(r"^## (\d\S+)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)[1]
    assert {PROJECT["project"]["version"], MANIFEST["version"], engine.__version__, VERSION, latest} == {"0.1.0"}


def test_the_engine_needs_three_libraries_only():
    assert {re.split("[<>=]", dependency)[0] for dependency in PROJECT["project"]["dependencies"]} == {"numpy", "embreex", "OpenEXR"}


def test_every_wheel_of_the_extension_has_a_checksum_and_no_other_has():
    lines = (ROOT / "tools" / "wheels.sha256").read_text().splitlines()
    assert sorted(line.split()[1] for line in lines) == sorted(WHEELS)
    assert all(re.fullmatch(r"[0-9a-f]{64}  \S+\.whl", line) for line in lines)


@pytest.mark.parametrize("platform", ["manylinux", "win_amd64", "macosx"])
@pytest.mark.parametrize("python", ["cp311", "cp313"])
@pytest.mark.parametrize("library", ["embreex", "openexr"])
def test_the_extension_has_the_wheel(library, python, platform):
    found = [wheel for wheel in WHEELS if wheel.startswith(library) and f"-{python}-{python}-" in wheel and platform in wheel]
    assert len(found) == 1


def test_the_extension_brings_no_numpy():
    # Blender has its own, and another would break it.
    assert not [wheel for wheel in WHEELS if wheel.startswith("numpy")]
