"""Blender's own command line reaches Glanz, as render farms use it."""

import sys

import bpy
import pytest

from glanz.addon import command_line
from glanz.engine import SceneError
from glanz.tests.addon import blender

BLENDER = ["blender", "-b", "scene.blend", "-E", "GLANZ", "-f", "1"]


def test_settings_behind_two_dashes_are_those_of_the_engine():
    words = [*BLENDER, "--", "--other", "7", "--glanz-samples", "3", "--glanz-integrator=whitted", "--glanz-filter-textures", "off"]
    assert command_line.overrides(words) == {"samples": 3, "integrator": "whitted", "filter_textures": False}


def test_what_stands_before_is_for_blender():
    assert command_line.overrides([*BLENDER, "--glanz-samples", "3"]) == {}
    assert command_line.overrides(["blender"]) == {}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--glanz-sampels", "3"], "--glanz-sampels is no setting of Glanz; known: .*--glanz-samples"),
        (["--glanz-width", "3"], "--glanz-width is no setting"),
        (["--glanz-samples", "many"], "--glanz-samples is 'many', a whole number is asked for"),
        (["--glanz-samples"], "--glanz-samples is '', a whole number"),
        (["--glanz-film-transparent", "perhaps"], "is 'perhaps', on or off"),
    ],
    ids=str,
)
def test_what_is_not_understood_is_said(words, message):
    with pytest.raises(SceneError, match=message):
        command_line.overrides([*BLENDER, "--", *words])


def test_a_render_follows_the_command_line(monkeypatch, tmp_path):
    blender.add_camera(width=8, height=8)
    blender.set_world((0.5, 0.5, 0.5))
    bpy.context.scene.glanz.samples = 4
    monkeypatch.setattr(sys, "argv", [*BLENDER, "--", "--glanz-samples", "2"])
    found = blender.header(blender.render(tmp_path / "a.exr"))
    assert {value for name, value in found.items() if name.endswith(".samples")} == {"2"}


def test_a_value_out_of_range_fails_the_render(monkeypatch, tmp_path):
    blender.add_camera(width=8, height=8)
    monkeypatch.setattr(sys, "argv", [*BLENDER, "--", "--glanz-samples", "0"])
    with pytest.raises(RuntimeError, match="samples is 0"):
        blender.render(tmp_path / "a.exr")


@pytest.mark.parametrize(("words", "code"), [(["--python-exit-code", "3"], 3), (["--python-exit-code", "0"], None), ([], None)], ids=str)
def test_blender_ends_with_the_status_that_it_was_asked_for(words, code, monkeypatch, tmp_path, capfd):
    """Where a picture cannot be rendered Blender alone would go on and end with 0."""
    blender.add_camera(width=8, height=8)
    ended = []
    monkeypatch.setattr(command_line.os, "_exit", ended.append)
    monkeypatch.setattr(sys, "argv", ["blender", "-b", *words, "-f", "1", "--", "--python-exit-code", "9", "--glanz-samples", "0"])
    with pytest.raises(RuntimeError):
        blender.render(tmp_path / "a.exr")
    assert capfd.readouterr().out.count("Error: setting samples is 0") == (3 if code else 2)
    assert ended == ([code] if code else [])


def test_blender_knows_the_programs_command(capfd):
    """`blender --command glanz` does what the program does."""
    assert command_line._registered
    assert command_line._command(["info", "nowhere.blend"]) == 1
    assert "nowhere.blend" in capfd.readouterr().err
