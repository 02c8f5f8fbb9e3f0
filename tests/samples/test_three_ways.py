"""Three ways in, one picture out: F12, `glanz render FILE.blend`, and `glanz render SCENE` where there is no Blender.

The linear pixels of all passes are the same bits; so they are with any number of threads and any size of tiles.
"""

import subprocess
import sys

import bpy
import numpy as np
import pytest

from glanz.engine.io.exr import read_exr
from glanz.tests.addon import blender
from glanz.tests.samples import samples

RUN = "import sys; from glanz.cli.main import run; sys.argv[1:] = {words!r}; run()"
WITHOUT_BLENDER = "import sys; sys.modules['bpy'] = sys.modules['mathutils'] = None; "


def glanz(folder, words, before=""):
    """The command line in a process of its own."""
    command = [sys.executable, "-c", before + RUN.format(words=words.split())]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def succeed(*arguments):
    done = glanz(*arguments)
    assert done.returncode == 0, done.stderr


def through_f12(path):
    """{pass: (height, width, channels)} of the open file, rendered in Blender."""
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_normal = True
    passes = blender.read_exr(blender.render(path))
    return {key.rpartition(".")[2]: values for key, values in passes.items() if key.startswith(f"{layer.name}.")}


def from_file(path):
    """The same of a file written by the command line."""
    channels = read_exr(path)
    names = {"Combined": "R G B A", "Depth": "Depth.Z", "Normal": "Normal.X Normal.Y Normal.Z"}
    return {key: np.stack([channels[c] for c in words.split()], axis=-1) for key, words in names.items()}


def assert_same_bits(ours, theirs):
    assert set(ours) == set(theirs) == {"Combined", "Depth", "Normal"}
    for key, values in ours.items():
        assert values.shape == theirs[key].shape
        assert values.dtype == theirs[key].dtype == np.float32
        assert values.tobytes() == theirs[key].tobytes(), f"{key}: {np.count_nonzero(values != theirs[key])} numbers differ"


@pytest.mark.parametrize("name", samples.NAMES)
def test_three_ways_give_the_same_bits(name, tmp_path):
    samples.open_sample(name, samples=3, side=80)
    inside = through_f12(tmp_path / "f12.exr")
    assert inside["Combined"][..., :3].any()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "file.blend"))
    succeed(tmp_path, "render file.blend -o blend.exr")
    succeed(tmp_path, "export file.blend -o file.glanz")
    succeed(tmp_path, "render file.glanz -o scene.exr", WITHOUT_BLENDER)
    assert_same_bits(from_file(tmp_path / "blend.exr"), inside)
    assert_same_bits(from_file(tmp_path / "scene.exr"), inside)
    # Bits can differ: other random numbers, also where the file has none.
    succeed(tmp_path, "render file.glanz -o other.exr --seed 1 --sampler random", WITHOUT_BLENDER)
    assert from_file(tmp_path / "other.exr")["Combined"].tobytes() != inside["Combined"].tobytes()


def test_there_is_no_blender_where_there_should_be_none(tmp_path):
    """Or the test above would show less than it says."""
    samples.open_sample("cornell_box", samples=1, side=8)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "file.blend"))
    done = glanz(tmp_path, "render file.blend -o blend.exr", WITHOUT_BLENDER)
    assert done.returncode == 1
    assert "bpy" in done.stderr
    assert not (tmp_path / "blend.exr").exists()


def test_a_transparent_film_is_the_same_three_ways(tmp_path):
    """The file's, and the command line's; PNG files have straight alpha."""
    scene = samples.open_sample("cornell_box", samples=2, side=24)
    scene.camera.rotation_euler.x += 0.3
    scene.render.film_transparent = True
    scene.render.image_settings.color_mode = "RGBA"
    inside = through_f12(tmp_path / "f12.exr")
    alpha = inside["Combined"][..., 3]
    assert alpha.min() == 0
    assert alpha.max() == 1
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "file.blend"))
    scene.render.film_transparent = False
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "opaque.blend"))
    succeed(tmp_path, "export file.blend -o file.glanz")
    succeed(tmp_path, "render file.glanz -o scene.exr -o scene.png", WITHOUT_BLENDER)
    succeed(tmp_path, "render opaque.blend --film-transparent -o blend.exr -o blend.png")
    for way in ("scene", "blend"):
        assert_same_bits(from_file(tmp_path / f"{way}.exr"), inside)
        image = bpy.data.images.load(str(tmp_path / f"{way}.png"))
        written = np.array(image.pixels[:]).reshape(24, 24, 4)[::-1, :, 3]
        np.testing.assert_allclose(written, alpha, atol=0.51 / 255)


@pytest.mark.parametrize("name", ["cornell_box", "lights"])
def test_neither_threads_nor_tiles_change_a_bit(name, tmp_path):
    scene = samples.open_sample(name, samples=3, side=100)
    scene.render.threads_mode = "FIXED"
    first = None
    for threads, tile_size in ((2, 64), (1, 64), (5, 64), (2, 16), (5, 16), (1, 0), (2, 0), (5, 7)):
        scene.render.threads, scene.glanz.tile_size = threads, tile_size
        pixels = through_f12(tmp_path / "a.exr")
        first = first or pixels
        assert_same_bits(pixels, first)
