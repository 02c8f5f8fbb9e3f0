"""Icons of materials, worlds and lights look as Cycles' do, come quickly, and stop nothing else."""

import time

import bpy
import numpy as np
import pytest

from glanz.addon import preview, render_engine
from glanz.engine import SceneError
from glanz.tests.addon import blender


def _icon(datablock, seconds=60):
    """(128, 128, 4), row 0 at the bottom, as displays show it; black where nothing came."""
    if datablock.preview:
        # Else Blender answers what it has.
        datablock.preview.image_size = (0, 0)
    datablock.preview_ensure()
    datablock.asset_generate_preview()
    end = time.monotonic() + seconds
    while bpy.app.is_job_running("RENDER_PREVIEW") and time.monotonic() < end:
        time.sleep(0.05)
    width, height = datablock.preview.image_size
    return np.array(datablock.preview.image_pixels_float[:], np.float32).reshape(height, width, 4)


def _red():
    return blender.new_material("Red", "ShaderNodeBsdfDiffuse", Color=(0.8, 0.1, 0.05, 1))


def _sky():
    return blender.set_world((0.2, 0.4, 0.8))


def _lamp():
    light = bpy.data.lights.new("Lamp", "POINT")
    light.color = (1, 0.5, 0.25)
    return light


@pytest.mark.parametrize(("make", "tolerance"), [(_red, 0.03), (_sky, 0.005), (_lamp, 0.08)])
def test_icons_are_those_of_cycles(make, tolerance):
    """The middle of the icon, as displays show it, by blocks of 8 by 8 pixels. Lamps shine on a dark floor of roughness 1, where our
    lobe is wider than GGX."""
    icons = []
    for engine in ("GLANZ", "CYCLES"):
        bpy.context.scene.render.engine = engine
        icons.append(_icon(make())[40:88, 40:88, :3].reshape(6, 8, 6, 8, 3).mean(axis=(1, 3)))
    own, cycles = icons
    assert own[..., 0].mean() != pytest.approx(own[..., 2].mean(), abs=0.15)
    np.testing.assert_allclose(own, cycles, atol=tolerance)


def test_what_a_picture_asks_for_is_not_asked_of_an_icon():
    scene, layer = bpy.context.scene, bpy.context.view_layer
    scene.glanz.samples, layer.samples, layer.use_pass_z = 4096, 9999, True
    scene.render.resolution_percentage = 50
    settings = preview.preview_settings(scene, layer, 96, 64)
    assert (settings.width, settings.height, settings.samples, settings.passes) == (96, 64, preview.SAMPLES, ("Combined",))


def test_an_icon_that_fails_is_told_to_the_log_alone(monkeypatch, caplog):
    """Neither an operator nor a render beside it hears of it, and the next icon comes."""

    def fail(*args, **kwargs):
        raise SceneError("object 'Ball' is odd")

    told = []
    monkeypatch.setattr(render_engine.GlanzRenderEngine, "report", lambda *args: told.append(args), raising=False)
    with monkeypatch.context() as patch, caplog.at_level("WARNING", "glanz"):
        patch.setattr(preview, "export_scene", fail)
        _icon(_red())
    assert [record.getMessage() for record in caplog.records] == ["preview: object 'Ball' is odd"]
    assert _icon(_sky())[64, 64, 2] > 0.5
    assert not told
