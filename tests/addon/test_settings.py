"""The file's settings reach the engine, unless they are overridden."""

import bpy
import pytest

from glanz.addon.settings import border, resolution, settings_of
from glanz.engine import SceneError
from glanz.tests.addon import blender


def _settings(**overrides):
    return settings_of(bpy.context.scene, bpy.context.view_layer, **overrides)


def test_the_files_settings_hold():
    blender.add_camera(width=200, height=100)
    scene = bpy.context.scene
    scene.render.resolution_percentage = 50
    scene.render.threads_mode, scene.render.threads = "FIXED", 3
    glanz = scene.glanz
    glanz.samples, glanz.max_depth, glanz.max_transparent, glanz.seed, glanz.tile_size = 9, 2, 7, -5, 32
    glanz.sampler, glanz.pixel_filter, glanz.filter_width = "random", "box", 2
    glanz.branches, glanz.min_contribution, glanz.light_falloff = 7, 0.25, False
    glanz.adaptive_threshold, glanz.adaptive_levels, glanz.filter_textures = 0.25, 5, False
    glanz.precision, scene.render.film_transparent = "exact", True
    s = _settings()
    assert s.film_transparent
    assert s.precision == "exact"
    assert (s.adaptive_threshold, s.adaptive_levels, s.filter_textures) == (0.25, 5, False)
    assert (s.width, s.height, s.border, s.threads) == (100, 50, (), 3)
    assert (s.samples, s.max_depth, s.max_transparent, s.seed, s.tile_size) == (9, 2, 7, -5, 32)
    assert (s.integrator, s.sampler, s.pixel_filter, s.filter_width) == ("path", "random", "box", 2)
    assert (s.branches, s.min_contribution, s.light_falloff) == (7, 0.25, False)
    assert s.passes == ("Combined",)


def test_automatic_threads_are_the_engines_choice():
    assert _settings().threads == 0


def test_overrides_win():
    s = _settings(samples=3, width=10, height=20, border=(1, 2, 3, 4))
    assert (s.samples, s.width, s.height, s.border) == (3, 10, 20, (1, 2, 3, 4))


def test_the_border_follows_an_overridden_size():
    render = bpy.context.scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0, 0.5, 0, 0.25
    assert _settings(width=40, height=80).border == (0, 60, 20, 80)


def test_a_view_layers_samples_win_over_the_scenes():
    bpy.context.view_layer.samples = 5
    assert _settings().samples == 5
    assert _settings(samples=2).samples == 2


def test_unknown_settings_are_named():
    with pytest.raises(SceneError, match="unknown settings colour"):
        _settings(colour=1)


def test_a_choice_that_no_longer_exists_is_named(monkeypatch):
    monkeypatch.setattr("glanz.addon.properties.enum_items", lambda name: [])
    with pytest.raises(SceneError, match="integrator"):
        _settings()


@pytest.mark.parametrize(
    ("fractions", "expected"),
    [((0, 1, 0, 1), ()), ((0.25, 0.75, 0, 0.5), (25, 25, 75, 50)), ((0, 0.999, 0.001, 1), (0, 0, 99, 50))],
)
def test_borders_are_cut_as_blender_does(fractions, expected):
    assert border(fractions, 100, 50) == expected


def test_percentages_round_down():
    assert resolution(101, 99, 50) == (50, 49)
