"""What may go wrong around a render, and how it ends: a message that names the cause, finished samples kept, Blender alive (faults J)."""

import resource
import signal
import subprocess
import sys
import textwrap

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


def test_frames_of_an_animation_are_looked_at_too(lit, limited, tmp_path):
    bpy.context.scene.frame_start = bpy.context.scene.frame_end = 7
    limited(100)
    save("PNG", tmp_path / "a_", animation=True)
    assert [path.name for path in tmp_path.iterdir()] == ["a_0007.png.cut_off"]


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
