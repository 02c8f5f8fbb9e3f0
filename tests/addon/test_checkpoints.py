"""F12 goes on from a checkpoint to the same picture, in every frame, layer and eye; one of another scene is replaced and told of."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from glanz.addon import render_engine, results
from glanz.addon.checkpoints import path_of
from glanz.addon.reports import Warnings
from glanz.engine import Checkpoint
from glanz.tests.addon import blender


@pytest.fixture
def scene(tmp_path):
    """A lamp over a plane, with a checkpoint as often as can be."""
    blender.add_camera(width=32, height=16)
    blender.add_plane(size=4)
    bpy.ops.object.light_add(type="AREA", location=(0, 0, 2))
    scene = bpy.context.scene
    scene.glanz.samples, scene.glanz.tile_size = 8, 8
    scene.glanz.checkpoint = str(tmp_path / "shot.checkpoint")
    return scene


@pytest.fixture
def told(monkeypatch):
    """All warnings that a render shows."""
    lines, show = [], Warnings.show
    monkeypatch.setattr(Warnings, "show", lambda self, found: (lines.extend(found), show(self, found)))
    return lines


def pixels(path):
    return blender.read_exr(blender.render(path))["ViewLayer.Combined"]


def cancelled_after(monkeypatch, tiles):
    """A render that is cancelled when it has written so many tiles, which may come at once, and a checkpoint after them."""
    written, write, saved, save = [], results.write_tile, [], Checkpoint.save
    monkeypatch.setattr(Checkpoint, "is_due", lambda self: True)
    monkeypatch.setattr(results, "write_tile", lambda *where: (written.append(1), write(*where)))
    monkeypatch.setattr(render_engine.GlanzRenderEngine, "is_cancelled", lambda self: len(written) >= tiles and bool(saved))
    monkeypatch.setattr(Checkpoint, "save", lambda self, state: (save(self, state), saved.append(1)))


def test_what_was_cancelled_goes_on(scene, tmp_path, told, monkeypatch):
    scene.glanz.checkpoint = ""
    whole = pixels(tmp_path / "whole.exr")
    scene.glanz.checkpoint = str(tmp_path / "shot.checkpoint")
    with monkeypatch.context() as patch:
        cancelled_after(patch, 3)
        blender.render(tmp_path / "cancelled.exr")
    (file,) = tmp_path.glob("shot_*.checkpoint")
    assert file.name == "shot_0001_ViewLayer.checkpoint"
    finished = []
    load = Checkpoint.load
    monkeypatch.setattr(Checkpoint, "load", lambda self: finished.append(load(self)) or finished[-1])
    np.testing.assert_array_equal(pixels(tmp_path / "parts.exr"), whole)
    assert finished[0].finished
    assert not file.exists()
    assert not told


def test_a_checkpoint_of_another_scene_is_replaced_and_told_of(scene, tmp_path, told):
    file = path_of(scene, "ViewLayer")
    file.write_bytes(b"something else")
    pixels(tmp_path / "a.exr")
    (line,) = told
    assert line.startswith(f"the checkpoint '{file.name}' is of another scene or other settings, or damaged, and is replaced")
    assert not file.exists()


def test_frames_layers_and_eyes_have_files_of_their_own(scene):
    scene.frame_current = 17
    assert path_of(scene, "View/Layer", "left").name == "shot_0017_View_Layer_left.checkpoint"
    scene.glanz.checkpoint = ""
    assert path_of(scene, "ViewLayer") is None


def test_a_path_beside_the_file_is_understood(tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    scene = SimpleNamespace(glanz=SimpleNamespace(checkpoint="//kept/x.ck"), frame_current=3, name="Scene")
    assert path_of(scene, "L") == tmp_path / "kept" / "x_0003_L.ck"


def test_where_nothing_can_be_written_is_an_error_before_the_work(scene, tmp_path):
    scene.glanz.checkpoint = str(tmp_path / "no folder" / "shot.checkpoint")
    with pytest.raises(RuntimeError, match="cannot write"):
        blender.render(tmp_path / "a.exr")
