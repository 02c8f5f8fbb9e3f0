"""Three ways in, one picture out: F12, `glanz render FILE.blend`, and `glanz render SCENE` where there is no Blender.

The linear pixels of all passes are the same bits; so they are with any number of threads and any size of tiles.
"""

import bpy
import numpy as np
import pytest

from glanz.engine.io.exr import read_exr
from glanz.tests.addon import blender
from glanz.tests.command_line import command_line
from glanz.tests.samples import samples


@pytest.fixture(scope="module")
def with_blender():
    with command_line() as run:
        yield run


@pytest.fixture(scope="module")
def without_blender():
    with command_line(has_blender=False) as run:
        yield run


def succeed(run, folder, words):
    done = run(folder, words)
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
def test_three_ways_give_the_same_bits(name, with_blender, without_blender, tmp_path):
    scene = samples.open_sample(name, samples=2, side=48)
    # More than one tile; and trees of rays grow quickly.
    scene.glanz.tile_size, scene.glanz.max_depth = 32, min(scene.glanz.max_depth, 5)
    inside = through_f12(tmp_path / "f12.exr")
    assert inside["Combined"][..., :3].any()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "file.blend"))
    succeed(with_blender, tmp_path, "render file.blend -o blend.exr")
    succeed(with_blender, tmp_path, "export file.blend -o file.glanz")
    succeed(without_blender, tmp_path, "render file.glanz -o scene.exr")
    assert_same_bits(from_file(tmp_path / "blend.exr"), inside)
    assert_same_bits(from_file(tmp_path / "scene.exr"), inside)
    # Bits can differ: other random numbers, also where the file has none.
    succeed(without_blender, tmp_path, "render file.glanz -o other.exr --seed 1 --sampler random")
    assert from_file(tmp_path / "other.exr")["Combined"].tobytes() != inside["Combined"].tobytes()


def test_there_is_no_blender_where_there_should_be_none(without_blender, tmp_path):
    """Or the test above would show less than it says."""
    samples.open_sample("cornell_box", samples=1, side=8)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "file.blend"))
    done = without_blender(tmp_path, "render file.blend -o blend.exr")
    assert done.returncode == 1
    assert "bpy" in done.stderr
    assert not (tmp_path / "blend.exr").exists()


def test_a_transparent_film_is_the_same_three_ways(with_blender, without_blender, tmp_path):
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
    succeed(with_blender, tmp_path, "export file.blend -o file.glanz")
    succeed(without_blender, tmp_path, "render file.glanz -o scene.exr -o scene.png")
    succeed(with_blender, tmp_path, "render opaque.blend --film-transparent -o blend.exr -o blend.png")
    for way in ("scene", "blend"):
        assert_same_bits(from_file(tmp_path / f"{way}.exr"), inside)
        image = bpy.data.images.load(str(tmp_path / f"{way}.png"))
        written = np.array(image.pixels[:]).reshape(24, 24, 4)[::-1, :, 3]
        np.testing.assert_allclose(written, alpha, atol=0.51 / 255)


@pytest.mark.parametrize("name", ["cornell_box", "lights"])
def test_neither_threads_nor_tiles_change_a_bit(name, tmp_path):
    scene = samples.open_sample(name, samples=2, side=70)
    scene.render.threads_mode = "FIXED"
    first = None
    for threads, tile_size in ((2, 64), (1, 64), (5, 64), (2, 16), (5, 16), (1, 0), (2, 0), (5, 7)):
        scene.render.threads, scene.glanz.tile_size = threads, tile_size
        pixels = through_f12(tmp_path / "a.exr")
        first = first or pixels
        assert_same_bits(pixels, first)
