"""What may go wrong around a render, and how it ends: a message that names the cause, finished samples kept, Blender alive (faults J)."""

import itertools
import random
import resource
import signal
import subprocess
import sys
import textwrap
import threading

import bpy
import numpy as np
import pytest

import glanz
from glanz import engine
from glanz.addon import render_engine, reports, results
from glanz.addon.capture import capture
from glanz.addon.files import save_png
from glanz.engine import rendering
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


# Interruptions


def at_each_look_for_esc(monkeypatch, action):
    """Let `action` (number) say whether Esc is pressed at that look of a render for it."""
    looks = itertools.count()
    monkeypatch.setattr(render_engine.GlanzRenderEngine, "is_cancelled", lambda engine: action(next(looks)))


@pytest.mark.parametrize(("progress", "noise"), [("TILES", 0.0), ("FRAME", 0.02)])
def test_esc_at_any_moment_leaves_what_is_finished_and_nothing_else(progress, noise, lit, tmp_path, monkeypatch):
    """Twenty moments from the first look to the last: whole tiles of the right radiance, no thread, and the next render is whole (J4)."""
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 40
    scene.glanz.tile_size, scene.glanz.progress, scene.glanz.samples = 8, progress, 4
    seen = []
    at_each_look_for_esc(monkeypatch, seen.append)
    whole = blender.read_exr(blender.render(tmp_path / "whole.exr"))["ViewLayer.Combined"]
    rng, finished = random.Random(1), []
    for _ in range(20):
        moment = rng.randrange(len(seen))
        at_each_look_for_esc(monkeypatch, lambda look, moment=moment: look >= moment)
        pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"]
        is_there = pixels[..., 3] > 0
        np.testing.assert_allclose(pixels[is_there], whole[is_there], rtol=noise)
        assert not pixels[~is_there].any()
        tiles = is_there.reshape(5, 8, 5, 8).sum(axis=(1, 3))
        assert np.isin(tiles, (0, 64)).all()
        finished.append(int(tiles.sum()) // 64)
        assert not [thread for thread in threading.enumerate() if thread.name.startswith("glanz")]
    assert len(set(finished)) > 1
    monkeypatch.undo()
    np.testing.assert_array_equal(blender.read_exr(blender.render(tmp_path / "b.exr"))["ViewLayer.Combined"], whole)


def test_results_are_begun_and_ended_by_the_thread_that_renders_alone(lit, tmp_path, monkeypatch):
    """Whatever threads there are (J20)."""
    writers, write = set(), results.write_tile
    monkeypatch.setattr(results, "write_tile", lambda *args: writers.add(threading.get_ident()) or write(*args))
    scene = bpy.context.scene
    scene.glanz.tile_size, scene.render.threads_mode, scene.render.threads = 8, "FIXED", 4
    blender.render(tmp_path / "a.exr")
    assert writers == {threading.get_ident()}


def test_what_is_deleted_during_a_render_is_rendered_all_the_same(lit, tmp_path, monkeypatch):
    """Everything was copied before (J21)."""
    bpy.context.scene.glanz.tile_size = 8
    whole = blender.read_exr(blender.render(tmp_path / "whole.exr"))["ViewLayer.Combined"]

    def delete(look):
        if look == 3:
            for data in (bpy.data.objects, bpy.data.meshes, bpy.data.worlds, bpy.data.materials):
                for block in list(data):
                    if block.name != "Camera":
                        data.remove(block)

    at_each_look_for_esc(monkeypatch, delete)
    np.testing.assert_array_equal(blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"], whole)
    assert not bpy.data.meshes


def test_an_exported_scene_outlives_its_file(lit):
    """Not a number of it is Blender's: with another file open it renders to the same bits (J21)."""
    image = bpy.data.images.new("Noise", 64, 64)
    image.pixels.foreach_set(np.random.default_rng(1).random(4 * 64 * 64, np.float32))
    body = blender.add_tetrahedron()
    body.data.materials.append(blender.new_material("Painted", "ShaderNodeBsdfDiffuse"))
    tree = body.data.materials[0].node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs[0], tree.nodes["Diffuse BSDF"].inputs[0])
    body.data.uv_layers.new()
    scene, _ = blender.export()
    settings = engine.Settings(width=16, height=16, samples=2, threads=1)
    before = engine.render_image(scene, settings).passes["Combined"]
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False)
    for _ in range(50):
        # What was freed is used again.
        blender.new_mesh("Other", [(number, 1, 2) for number in range(3000)], [])
    np.testing.assert_array_equal(engine.render_image(scene, settings).passes["Combined"], before)


def test_glanz_is_not_switched_off_while_it_renders(lit, tmp_path, monkeypatch):
    """Blender would crash (J21). Afterwards it is."""
    refused = []

    def switch_off(look):
        if look == 2:
            with pytest.raises(RuntimeError, match="Glanz renders a picture just now: end that, then switch Glanz off") as error:
                glanz.unregister()
            refused.append(error)

    at_each_look_for_esc(monkeypatch, switch_off)
    assert blender.render(tmp_path / "a.exr").exists()
    assert refused
    glanz.unregister()
    assert not hasattr(bpy.types.Scene, "glanz")
    glanz.register()


def test_without_a_camera_it_is_said_and_nothing_is_written(lit, tmp_path, capfd):
    """Blender refuses before Glanz is asked; Glanz would too (J13)."""
    bpy.data.objects.remove(bpy.context.scene.camera)
    with pytest.raises(RuntimeError, match="no camera"):
        blender.render(tmp_path / "a.exr")
    with pytest.raises(engine.SceneError, match="scene 'Scene' has no camera"):
        capture()
    assert "Traceback" not in capfd.readouterr().err
    assert not list(tmp_path.iterdir())


def test_collections_in_collections_in_collections_are_no_recursion_of_ours(lit, tmp_path):
    """Instances nested more deeply than Blender itself unfolds them, which says how deep that is (J23)."""
    inner = bpy.data.collections.new("0")
    inner.objects.link(blender.add_tetrahedron())
    for number in range(1, 40):
        empty = bpy.data.objects.new(f"Instance {number}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", inner
        inner = bpy.data.collections.new(str(number))
        inner.objects.link(empty)
    blender.link("Outermost", None).instance_type = "COLLECTION"
    bpy.data.objects["Outermost"].instance_collection = inner
    assert np.isfinite(blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"]).all()


# Files that Blender writes


@pytest.fixture
def limited():
    """A function that lets files grow to so many bytes only, in the place of a full disk."""
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    yield lambda size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    resource.setrlimit(resource.RLIMIT_FSIZE, before)
    signal.signal(signal.SIGXFSZ, handler)


FORMATS = {"PNG": "a.png", "OPEN_EXR": "a.exr", "OPEN_EXR_MULTILAYER": "a.exr"}


def save(kind, path, **how):
    """F12 into a file of a format."""
    image = bpy.context.scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "MULTI_LAYER_IMAGE" if "MULTI" in kind else "IMAGE"
    image.file_format = kind
    bpy.context.scene.render.filepath = str(path)
    bpy.ops.render.render(**(how or {"write_still": True}))


@pytest.mark.parametrize("kind", FORMATS)
def test_a_file_that_a_full_disk_cuts_off_does_not_pass_for_a_picture(kind, lit, limited, tmp_path, caplog):
    """Of all sizes up to a byte less than the whole. Blender says "Saved", and its operator that all is well (J10)."""
    whole = tmp_path / FORMATS[kind]
    save(kind, whole)
    size = whole.stat().st_size
    assert not caplog.records
    for limit in (1, 100, size // 2, size - 1):
        limited(limit)
        save(kind, whole)
        assert [path.name for path in tmp_path.iterdir()] == [f"{whole.name}.cut_off"]
        assert f"the picture '{whole}' was cut off when it was saved, is the disk full?" in caplog.text
        caplog.clear()


def test_a_picture_through_the_view_transform_is_whole_or_not_there(limited, tmp_path):
    """What the command line writes as PNG by way of Blender."""
    image = engine.Image(64, 64, {"Combined": np.random.default_rng(1).random((64, 64, 4), np.float32)})
    save_png(image, tmp_path / "a.png")
    old = (tmp_path / "a.png").read_bytes()
    for limit in (1, len(old) // 2, len(old) - 1):
        limited(limit)
        with pytest.raises(engine.FileError, match=r"cannot write .*a\.png"):
            save_png(image, tmp_path / "a.png")
        assert [path.name for path in tmp_path.iterdir()] == ["a.png"]
        assert (tmp_path / "a.png").read_bytes() == old


def test_frames_of_an_animation_are_looked_at_too(lit, limited, tmp_path):
    bpy.context.scene.frame_start = bpy.context.scene.frame_end = 7
    limited(100)
    save("PNG", tmp_path / "a_", animation=True)
    assert [path.name for path in tmp_path.iterdir()] == ["a_0007.png.cut_off"]


def test_files_that_were_there_before_are_left_alone(lit, tmp_path):
    """Whoever has cut them off."""
    (tmp_path / "a_.png").write_bytes(b"half of")
    bpy.context.scene.frame_start = bpy.context.scene.frame_end = 7
    save("PNG", tmp_path / "a_", animation=True)
    assert (tmp_path / "a_.png").read_bytes() == b"half of"
    assert {path.name for path in tmp_path.iterdir()} == {"a_.png", "a_0007.png"}


def test_eyes_with_files_of_their_own_are_looked_at_too(lit, limited, tmp_path):
    render = bpy.context.scene.render
    render.use_multiview = True
    render.image_settings.views_format = "INDIVIDUAL"
    save("PNG", tmp_path / "a.png")
    names = {path.name for path in tmp_path.iterdir()}
    assert len(names) == 2
    limited(100)
    save("PNG", tmp_path / "a.png")
    assert {path.name for path in tmp_path.iterdir()} == {f"{name}.cut_off" for name in names}


@pytest.mark.parametrize("how", [{"write_still": True}, {"animation": True}], ids=["still", "animation"])
def test_where_nothing_can_be_saved_is_told_before_the_work(how, lit, tmp_path, monkeypatch):
    """Where a folder should be is a file (J11). An animation is not even begun."""
    (tmp_path / "file").write_text("mine")
    told, begun, render = [], [], rendering.render_plan
    monkeypatch.setattr(rendering, "render_plan", lambda *args, **kwargs: begun.append(len(told)) or render(*args, **kwargs))
    monkeypatch.setattr(reports.Warnings, "show", lambda self, lines: told.extend(lines))
    bpy.context.scene.frame_start = bpy.context.scene.frame_end = 1
    with pytest.raises(RuntimeError, match="file"):
        save("PNG", tmp_path / "file" / "a", **how)
    assert begun == ([1] if "write_still" in how else [])
    if "write_still" in how:
        assert told[0].startswith(
            f"scene 'Scene': its picture cannot be saved as '{tmp_path}/file/a0001.png': '{tmp_path}/file' is not to be"
        )
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    assert (tmp_path / "file").read_text() == "mine"


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="paths have no templates")
def test_a_path_that_blender_does_not_understand_is_said_before_the_work(lit, tmp_path):
    for how in ({"write_still": True}, {"animation": True}):
        with pytest.raises(RuntimeError, match=r"\{bad\}"):
            save("PNG", tmp_path / "{bad}" / "a", **how)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="paths have no templates")
def test_names_that_blender_fills_in_are_looked_at_too(lit, limited, tmp_path):
    limited(100)
    save("PNG", tmp_path / "{blend_name}")
    assert [path.name for path in tmp_path.iterdir()] == ["Unsaved.png.cut_off"]


def test_folders_that_blender_makes_are_no_obstacle(lit, tmp_path):
    save("PNG", tmp_path / "new" / "one" / "a.png")
    assert (tmp_path / "new" / "one" / "a.png").exists()


def test_a_farm_is_told_by_the_exit_status(tmp_path):
    script = """
        limit(100)
        blender.render(folder / "a.exr")
        print("goes on")
    """
    done = background(script, tmp_path, "--python-exit-code", "4")
    assert done.returncode == 4, done.stderr
    assert "Error: the picture" in done.stdout
    assert "goes on" not in done.stdout


# A process of its own

PRELUDE = """
    import os, resource, signal, sys
    from pathlib import Path
    import bpy, glanz
    from glanz.tests.addon import blender
    folder = Path(sys.argv[1])
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    glanz.register()
    scene = bpy.context.scene
    scene.render.engine = "GLANZ"
    blender.add_camera(width=16, height=16)
    blender.set_world((1, 1, 1))
    blender.add_plane(size=20)
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    def limit(size):
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))

    def leave(status):
        sys.stdout.flush()
        os._exit(status)
"""


def background(script, folder, *words):
    """What becomes of a `script` in a Blender of its own, whose command line has these `words`."""
    code = textwrap.dedent(PRELUDE) + textwrap.dedent(script)
    return subprocess.run([sys.executable, "-c", code, str(folder), *words], capture_output=True, text=True, errors="replace", timeout=300)


def test_a_picture_beyond_the_memory_of_the_process_is_refused_and_blender_goes_on(tmp_path):
    """Blender alone ends by a segmentation fault (J8)."""
    script = """
        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + 2**30, resource.RLIM_INFINITY))
        scene.render.resolution_x = scene.render.resolution_y = 16384
        try:
            blender.render(folder / "a.exr")
        except RuntimeError as error:
            print("TOLD", error)
        scene.render.resolution_x = scene.render.resolution_y = 16
        blender.render(folder / "b.exr")
        leave(5)
    """
    done = background(script, tmp_path)
    assert done.returncode == 5, done.stderr
    assert "TOLD Error: Blender's picture and its copy, 16384x16384 px with 4 channels, need about 8.0 GiB of memory" in done.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["b.exr"]
