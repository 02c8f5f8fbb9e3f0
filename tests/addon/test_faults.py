"""What may go wrong around a render, and how it ends: a message that names the cause, finished samples kept, Blender alive (faults J)."""

import bpy
import pytest

from glanz.tests.addon import blender


@pytest.fixture
def lit():
    """A plane in a bright world."""
    blender.add_camera(width=16, height=16)
    blender.set_world((1, 1, 1))
    return blender.add_plane(size=20)


def test_a_scene_without_a_view_layer_to_render_is_an_error_and_no_crash(lit, tmp_path):
    """Saving a picture that there never was is a crash of Blender, with Cycles too."""
    layer = bpy.context.view_layer
    layer.use = False
    with pytest.raises(RuntimeError, match="no view layer is rendered: switch on Use for Rendering"):
        blender.render(tmp_path / "a.exr")
    assert not list(tmp_path.iterdir())
    layer.use = True
    assert blender.render(tmp_path / "a.exr").exists()


def test_persistent_data_does_not_hide_that_nothing_was_rendered(lit, tmp_path):
    bpy.context.scene.render.use_persistent_data = True
    blender.render(tmp_path / "a.exr")
    bpy.context.view_layer.use = False
    with pytest.raises(RuntimeError, match="no view layer is rendered"):
        blender.render(tmp_path / "b.exr")
