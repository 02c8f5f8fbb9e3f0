"""The gallery shows what its commands make: the page is the table's, every picture is there, and every scene exists."""

import importlib.util
import sys
from pathlib import Path

import pytest

from glanz.cli.arguments import parser

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def gallery():
    spec = importlib.util.spec_from_file_location("gallery", ROOT / "tools/gallery.py")
    module = sys.modules["gallery"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_is_that_of_the_table(gallery):
    assert (ROOT / "docs/gallery.md").read_text(encoding="utf-8") == gallery.page()


def test_every_picture_is_there_and_none_is_left_over(gallery):
    named = {f"{picture.name}.png" for section in gallery.SECTIONS for picture in section.pictures}
    assert named == {path.name for path in (ROOT / gallery.IMAGES).iterdir()}
    assert (ROOT / "docs/images/zone_plate.png").exists()


def test_every_command_is_understood_and_its_scene_exists(gallery):
    for section in gallery.SECTIONS:
        assert (ROOT / f"sample_scenes/{section.scene}.blend").exists()
        for picture in section.pictures:
            arguments = parser("1").parse_args(section.command(picture).split()[1:])
            assert arguments.output == [f"{gallery.IMAGES}/{picture.name}.png"]
