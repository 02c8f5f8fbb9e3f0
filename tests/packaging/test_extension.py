"""The zips hold what belongs into the extension and nothing else, and Blender's own validator likes them."""

import importlib.util
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PLATFORMS = ["linux-x64", "windows-x64", "macos-arm64"]


@pytest.fixture
def tools(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    import build_extension
    import fetch_wheels

    yield build_extension, fetch_wheels
    for name in ("build_extension", "fetch_wheels"):
        sys.modules.pop(name)


@pytest.fixture
def source(tmp_path):
    """A stand-in for the repository: its real manifest, a little code, and things that must stay out."""
    root = tmp_path / "root"
    for name, text in {
        "__init__.py": "",
        "README.md": "# Glanz",
        "LICENSE": "GPL",
        "LICENSES/MIT.txt": "MIT",
        "addon/__init__.py": "",
        "addon/presets/a.py": "",
        "engine/__init__.py": "",
        "engine/maths/skydome.csv": "1,2",
        "engine/__pycache__/x.pyc": "",
        "engine/.hidden": "",
        "tests/test_x.py": "",
        "cli/main.py": "",
    }.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    (root / "blender_manifest.toml").write_bytes((ROOT / "blender_manifest.toml").read_bytes())
    (root / "wheels").mkdir()
    for wheel in tomllib.loads((ROOT / "blender_manifest.toml").read_text())["wheels"]:
        (root / wheel).write_bytes(b"a wheel")
    return root


CODE = {
    "__init__.py", "README.md", "LICENSE", "LICENSES/MIT.txt", "addon/__init__.py", "addon/presets/a.py", "cli/main.py",
    "engine/__init__.py", "engine/maths/skydome.csv", "blender_manifest.toml",
}  # fmt: skip


@pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="bpy, which brings the builder, is not installed for this Python")
@pytest.mark.parametrize("platforms", [PLATFORMS, ["linux-x64"]], ids=len)
def test_each_zip_holds_the_code_and_the_wheels_of_its_platform(tools, source, tmp_path, platforms):
    build_extension, _ = tools
    build_extension.stage(source, tmp_path / "staging", platforms, source / "wheels")
    (tmp_path / "dist").mkdir()
    zips = build_extension.build(tmp_path / "staging", tmp_path / "dist")
    assert {path.name for path in zips} == {f"glanz-0.1.0-{platform.replace('-', '_')}.zip" for platform in platforms}
    declared = tomllib.loads((ROOT / "blender_manifest.toml").read_text())["wheels"]
    for platform in platforms:
        path = tmp_path / "dist" / f"glanz-0.1.0-{platform.replace('-', '_')}.zip"
        wheels = {wheel.removeprefix("./") for wheel in declared if build_extension.is_for(wheel, [platform])}
        assert len(wheels) >= 4
        with zipfile.ZipFile(path) as file:
            names = {name for name in file.namelist() if not name.endswith("/")}
            manifest = tomllib.loads(file.read("blender_manifest.toml").decode())
        assert names == CODE | wheels
        assert {wheel.removeprefix("./") for wheel in manifest["build"]["generated"]["wheels"]} == wheels


def test_every_wheel_is_for_exactly_one_platform(tools):
    build_extension, fetch_wheels = tools
    for wheel in fetch_wheels.checksums():
        assert sum(build_extension.is_for(wheel, [platform]) for platform in PLATFORMS) == 1


def test_a_wheel_that_is_not_the_known_one_is_thrown_away(tools, tmp_path):
    _, fetch_wheels = tools
    name = next(iter(fetch_wheels.checksums()))
    (tmp_path / name).write_bytes(b"something else")
    with pytest.raises(SystemExit, match="not the file"):
        fetch_wheels.fetch([name], tmp_path, fetch_wheels.checksums())
    assert not (tmp_path / name).exists()


def test_a_wheel_without_a_checksum_is_refused(tools, tmp_path):
    _, fetch_wheels = tools
    with pytest.raises(SystemExit, match=r"new-1\.whl"):
        fetch_wheels.fetch(["new-1.whl"], tmp_path, {})


def test_a_download_asks_for_exactly_the_declared_wheel(tools, tmp_path):
    _, fetch_wheels = tools
    command = fetch_wheels.download_command("x-1.2.post1-cp313-cp313-manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl", tmp_path)
    words = " ".join(command)
    assert "--platform manylinux_2_27_x86_64 --platform manylinux_2_28_x86_64" in words
    assert "--python-version 313 --abi cp313" in words
    assert words.endswith("x==1.2.post1")
    assert "--no-deps" in command
    assert "--only-binary=:all:" in command
