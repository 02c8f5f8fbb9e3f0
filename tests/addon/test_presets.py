"""A preset makes of any settings what it says, touches no others, and can be undone."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from glanz.addon import backend, presets
from glanz.addon.presets import PRESETS
from glanz.addon.settings import settings_of
from glanz.tests.addon import blender

ODD = {
    "integrator": "whitted",
    "samples": 7,
    "max_depth": 31,
    "sampler": "random",
    "adaptive_threshold": 0.77,
    "adaptive_levels": 5,
    "branches": 99,
    "min_contribution": 0.9,
    "light_falloff": False,
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


@pytest.mark.parametrize("key", PRESETS)
def test_every_preset_gives_a_picture(key, tmp_path):
    """A wall that shines is as bright by any of them."""
    blender.add_camera(width=8, height=8)
    lamp = blender.new_material("Lamp", "ShaderNodeEmission", Color=(1, 0.5, 0.25, 1), Strength=1)
    blender.add_plane(size=20).data.materials.append(lamp)
    bpy.ops.glanz.sampling_preset(preset=key)
    pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"]
    np.testing.assert_allclose(pixels, np.broadcast_to((1, 0.5, 0.25, 1), pixels.shape), rtol=1e-5)


def test_the_menu_offers_each_with_its_cost():
    drawn = []

    def operator(name, text):
        drawn.append((name, text, button := SimpleNamespace()))
        return button

    presets.GLANZ_MT_sampling_presets.draw(SimpleNamespace(layout=SimpleNamespace(operator=operator)), None)
    assert [(text, button.preset) for _, text, button in drawn] == [(preset.label, key) for key, preset in PRESETS.items()]
    assert {name for name, _, _ in drawn} == {"glanz.sampling_preset"}
    for _, _, button in drawn:
        tooltip = presets.GLANZ_OT_sampling_preset.description(None, button)
        assert "time" in tooltip
        assert "noise" in tooltip.lower() or button.preset == "BALANCED"


def test_without_the_engine_there_is_nothing_to_choose(monkeypatch):
    assert bpy.ops.glanz.sampling_preset.poll()
    monkeypatch.setattr(backend, "engine", lambda: None)
    assert not bpy.ops.glanz.sampling_preset.poll()
