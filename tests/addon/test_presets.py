"""A preset makes of any settings what it says and touches no others, and its tooltip says what was measured; users have their own."""

import json
import re
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

import glanz
from glanz.addon import backend, presets
from glanz.addon.presets import PRESETS
from glanz.addon.settings import settings_of
from glanz.benchmarks.presets.__main__ import told
from glanz.tests.addon import blender

ODD = {
    "integrator": "whitted",
    "samples": 7,
    "max_depth": 31,
    "sampler": "random",
    "error_target": 0.5,
    "error_measure": "lightness",
    "adaptive_sampling": False,
    "time_limit": 77.0,
    "replicates": 3,
    "adaptive_threshold": 0.77,
    "adaptive_levels": 5,
    "branches": 99,
    "min_contribution": 0.9,
    "light_falloff": False,
    "clamp_direct": 3.0,
    "clamp_indirect": 2.0,
}
"""Settings that no preset has."""


@pytest.mark.parametrize("key", PRESETS)
def test_it_does_not_matter_what_was_before(key):
    glanz = bpy.context.scene.glanz
    for name, value in ODD.items():
        setattr(glanz, name, value)
    glanz.seed, glanz.pixel_filter, glanz.tile_size = 5, "box", 16
    assert bpy.ops.glanz.sampling_preset(preset=key) == {"FINISHED"}
    settings = settings_of(bpy.context.scene, bpy.context.view_layer)
    assert {name: getattr(settings, name) for name in ODD} == pytest.approx(PRESETS[key].settings)
    assert (settings.seed, settings.pixel_filter, settings.tile_size) == (5, "box", 16)


def test_balanced_asks_for_what_new_files_have_but_for_twice_the_paths():
    fresh = settings_of(bpy.context.scene, bpy.context.view_layer)
    balanced = PRESETS["BALANCED"].settings
    assert {name: value for name, value in balanced.items() if getattr(fresh, name) != value} == {"samples": 2 * fresh.samples}


def _measured():
    """docs/presets.json."""
    path = Path(glanz.__file__).parent / "docs" / "presets.json"
    if not path.exists():
        pytest.skip("installed without docs")
    return json.loads(path.read_text(encoding="utf-8"))


def _number(words):
    """That of "1/7" or "2.9"."""
    part, _, whole = words.partition("/")
    return float(part) / float(whole or 1)


def _told(tooltip):
    """{"time", and "error" or "noise": [median, least, most]} in the words of a tooltip."""
    number = r"([\d./]+)"
    found = re.findall(rf"{number} (?:of|times) the (time|error|noise)[A-Za-z ]*\({number} to {number}\)", tooltip)
    return {what: [_number(words) for words in own] for median, what, *rest in found for own in [(median, *rest)]}


def _disagreements(key, tooltip, summary):
    """What a tooltip tells otherwise than was measured: by more than 15 %, which is more than its words round by."""
    if key == "BALANCED":
        # It is told relative to Preview, as all others are to it.
        summary = {"BALANCED": {what: [1 / own[0], 1 / own[2], 1 / own[1]] for what, own in summary["PREVIEW"].items() if what != "bias"}}
    found = _told(tooltip)
    assert "time" in found and len(found) == 2
    return [
        (what, told, true)
        for what, numbers in found.items()
        for told, true in zip(numbers, summary[key][what], strict=True)
        if not abs(told / true - 1) <= 0.15
    ]


@pytest.mark.parametrize("key", PRESETS)
def test_tooltips_tell_what_was_measured(key):
    """Of the settings that presets have now. Noticed: a median, or an end of a range, that is off by a third."""
    measured = _measured()
    assert measured["presets"][key] == pytest.approx(told(PRESETS[key].settings))
    assert _disagreements(key, PRESETS[key].cost, measured["summary"]) == []
    for place in range(3):
        wrong = json.loads(json.dumps(measured["summary"]))
        wrong["PREVIEW" if key == "BALANCED" else key]["time"][place] *= 1.35
        assert len(_disagreements(key, PRESETS[key].cost, wrong)) == 1


@pytest.mark.parametrize(
    ("value", "words"), [(0.143, "1/7"), (0.5, "1/2"), (0.4, "0.4"), (0.7, "0.7"), (0.97, "0.97"), (1, "1"), (2.94, "2.9"), (11.3, "11")]
)
def test_ratios_are_told_in_words_to_a_twentieth(value, words):
    assert presets._ratio(value) == words
    assert _number(words) == pytest.approx(value, rel=0.05)


@pytest.mark.parametrize("key", PRESETS)
def test_every_preset_gives_a_picture(key, tmp_path):
    """A wall that shines is as bright by any of them."""
    blender.add_camera(width=8, height=8)
    lamp = blender.new_material("Lamp", "ShaderNodeEmission", Color=(1, 0.5, 0.25, 1), Strength=1)
    blender.add_plane(size=20).data.materials.append(lamp)
    bpy.ops.glanz.sampling_preset(preset=key)
    pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"]
    np.testing.assert_allclose(pixels, np.broadcast_to((1, 0.5, 0.25, 1), pixels.shape), rtol=1e-5)


def _panel():
    """What the panel of presets draws: (operator, text, what its button is given)."""
    drawn = []

    class Layout:
        def operator(self, name, text="", **options):
            drawn.append((name, text, SimpleNamespace()))
            return drawn[-1][2]

        def column(self, **options):
            return self

        row = column

        def separator(self, **options):
            pass

        def prop(self, owner, name, **options):
            assert hasattr(owner, name)

    kind = presets.GLANZ_PT_sampling_presets
    asked = {name: getattr(kind, name) for name in dir(kind) if name.startswith("preset_")}
    kind.draw(type("Panel", (presets.PresetPanel,), asked | {"bl_idname": kind.__name__, "layout": Layout()})(), bpy.context)
    return drawn


def test_the_panel_offers_each_with_its_cost():
    drawn = [(text, button) for name, text, button in _panel() if name == "glanz.sampling_preset"]
    assert [(text, button.preset) for text, button in drawn] == [(preset.label, key) for key, preset in PRESETS.items()]
    for _, button in drawn:
        tooltip = presets.GLANZ_OT_sampling_preset.description(None, button)
        assert "time" in tooltip
        assert "noise" in tooltip or "error" in tooltip


def test_without_the_engine_there_is_nothing_to_choose(monkeypatch):
    assert bpy.ops.glanz.sampling_preset.poll()
    assert bpy.ops.glanz.sampling_preset_add.poll()
    monkeypatch.setattr(backend, "engine", lambda: None)
    assert not bpy.ops.glanz.sampling_preset.poll()
    assert not bpy.ops.glanz.sampling_preset_add.poll()


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder of a user's presets, not that of whoever runs the tests."""
    monkeypatch.setenv("BLENDER_USER_SCRIPTS", str(tmp_path))
    return tmp_path / "presets" / "glanz"


def test_users_add_choose_and_remove_their_own(folder):
    glanz = bpy.context.scene.glanz
    for name, value in ODD.items():
        setattr(glanz, name, value)
    assert bpy.ops.glanz.sampling_preset_add(name="Mürrisch 2") == {"FINISHED"}
    (path,) = folder.iterdir()
    (chosen,) = (button for name, text, button in _panel() if (name, text) == ("script.execute_preset", "Mürrisch 2"))
    assert chosen.filepath == str(path)

    bpy.ops.glanz.sampling_preset(preset="PREVIEW")
    assert bpy.ops.script.execute_preset(filepath=chosen.filepath, menu_idname=chosen.menu_idname) == {"FINISHED"}
    assert {name: getattr(glanz, name) for name in ODD} == pytest.approx(ODD)

    (minus,) = (button for name, _, button in _panel() if getattr(button, "remove_name", False))
    assert bpy.ops.glanz.sampling_preset_add(name=minus.name, remove_name=True) == {"FINISHED"}
    assert not list(folder.iterdir())
    assert "script.execute_preset" not in {name for name, _, _ in _panel()}


@pytest.mark.parametrize("label", [preset.label for preset in PRESETS.values()])
def test_glanzs_own_are_neither_replaced_nor_removed(label, folder):
    assert bpy.ops.glanz.sampling_preset_add(name=label) == {"CANCELLED"}
    assert not folder.exists()
    assert bpy.ops.glanz.sampling_preset_add(name=label, remove_name=True) == {"CANCELLED"}
    assert label in {text for _, text, _ in _panel()}
