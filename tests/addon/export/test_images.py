"""Images of more than one file: sequences and tiles; colour spaces; what is missing."""

import struct

import bpy
import numpy as np
import pytest

from glanz.addon.export import images
from glanz.engine import ImageTexture
from glanz.engine.scene.graphs import with_inner
from glanz.tests.addon import blender
from glanz.tests.addon.export.test_textures import exported, textured
from glanz.tests.addon.sky import set_sky


def save(path, grey, space="sRGB"):
    """A file of 4 x 2 texels whose codes are `grey`, from 0 to 255."""
    image = bpy.data.images.new("Scratch", 4, 2)
    image.pixels.foreach_set(np.tile(np.float32((grey / 255,) * 3 + (1,)), 8))
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)


def shown(image, **user):
    """(the texture that shows an image, warnings)."""
    material, _, node = textured("Image")
    node.image = image
    for name, value in user.items():
        setattr(node.image_user, name, value)
    o, warnings = exported(material)
    texture = o.materials[0].lobes[0].reflectance
    assert type(texture) is ImageTexture or warnings
    return texture, warnings


def sequence(folder, frames=(1, 2, 3, 4)):
    """An image whose frame f has the code 10 f."""
    for frame in frames:
        save(folder / f"picture_{frame:04}.png", 10 * frame)
    image = bpy.data.images.load(str(folder / f"picture_{frames[0]:04}.png"))
    image.source = "SEQUENCE"
    return image


def movie(folder, frames=(1, 2, 3, 4)):
    """A movie of 16 x 16 texels whose frame f has the code 10 f: an AVI file of bitmaps as they are."""

    def chunk(name, content):
        return name + struct.pack("<I", len(content)) + content

    def parts(name, *chunks):
        return chunk(b"LIST", name + b"".join(chunks))

    size = 16 * 16 * 3
    head = struct.pack("<14I", 40_000, 25 * size, 0, 0, len(frames), 0, 1, size, 16, 16, 0, 0, 0, 0)
    stream = b"vidsDIB " + struct.pack("<10I4H", 0, 0, 0, 1, 25, 0, len(frames), size, 0, 0, 0, 0, 16, 16)
    bitmap = struct.pack("<IiiHHIIiiII", 40, 16, 16, 1, 24, 0, size, 0, 0, 0, 0)
    header = parts(b"hdrl", chunk(b"avih", head), parts(b"strl", chunk(b"strh", stream), chunk(b"strf", bitmap)))
    pictures = parts(b"movi", *(chunk(b"00db", bytes([10 * frame]) * size) for frame in frames))
    path = folder / "cut.avi"
    path.write_bytes(chunk(b"RIFF", b"AVI " + header + pictures))
    return bpy.data.images.load(str(path))


@pytest.mark.parametrize("make", [sequence, movie])
@pytest.mark.parametrize(
    ("frame", "user", "expected"),
    [
        (1, {}, 1),
        (3, {}, 3),
        (9, {}, 4),
        (6, {"use_cyclic": True}, 2),
        (3, {"frame_start": 2}, 2),
        (2, {"frame_offset": 1}, 3),
        (4, {"frame_duration": 2}, 2),
        (-1, {"use_cyclic": True, "frame_offset": 1, "frame_duration": 3}, 3),
        (3, {"use_auto_refresh": False}, 3),
    ],
)
def test_a_sequence_or_movie_shows_the_frame_that_cycles_shows(tmp_path, make, frame, user, expected):
    image = make(tmp_path)
    count = len(bpy.data.images)
    bpy.context.scene.frame_set(frame)
    texture, warnings = shown(image, **{"use_auto_refresh": True, "frame_duration": 4, "frame_start": 1, "frame_offset": 0, **user})
    assert warnings == ()
    assert (texture.bitmap.pixels[:3] == 10 * expected).all()
    # Read apart from the open file.
    assert len(bpy.data.images) == count


@pytest.mark.parametrize("make", [sequence, movie])
def test_a_world_shows_the_same_frame(tmp_path, make):
    image = make(tmp_path)
    node = set_sky(image)
    for name, value in {"frame_duration": 4, "frame_start": 2, "frame_offset": 0}.items():
        setattr(node.image_user, name, value)
    bpy.context.scene.frame_set(4)
    scene, warnings = blender.export()
    assert warnings == ()
    code = 30 / 255
    np.testing.assert_allclose(scene.world.environment.pixels[:, 0, 0], ((code + 0.055) / 1.055) ** 2.4, rtol=1e-3)


def test_a_frame_that_is_missing_is_magenta_and_named(tmp_path):
    image = sequence(tmp_path, (1, 3))
    bpy.context.scene.frame_set(2)
    texture, (warning,) = shown(image, use_auto_refresh=True, frame_duration=4, frame_start=1)
    assert "magenta" in warning and image.name in warning
    assert texture.bitmap.pixels[:, 0, 0].tolist()[:3] == [1, 0, 1]


def tiled(folder, numbers=(1001, 1002, 1011), present=(1001, 1002, 1011)):
    """An image whose tile 1001 + n has the code 10 (n + 1)."""
    for number in present:
        save(folder / f"skin.{number}.png", 10 * (number - 1000))
    image = bpy.data.images.load(str(folder / f"skin.{numbers[0]}.png"))
    image.source = "TILED"
    image.filepath = str(folder / "skin.<UDIM>.png")
    for number in numbers[1:]:
        if number not in [tile.number for tile in image.tiles]:
            image.tiles.new(tile_number=number)
    return image


def codes(texture):
    return {number: int(bitmap.pixels[0, 0, 0]) for number, bitmap in texture.tiles}


def test_a_tiled_image_brings_every_tile(tmp_path):
    texture, warnings = shown(tiled(tmp_path))
    assert warnings == ()
    assert codes(texture) == {1001: 10, 1002: 20, 1011: 110}


def test_a_tile_that_is_missing_is_named(tmp_path):
    texture, (warning,) = shown(tiled(tmp_path, present=(1001, 1011)))
    assert "tile 1002" in warning and "magenta" in warning
    assert codes(texture) == {1001: 10, 1011: 110}


def test_a_packed_tiled_image_needs_no_files(tmp_path):
    image = tiled(tmp_path)
    image.pack()
    for path in tmp_path.glob("*.png"):
        path.unlink()
    texture, warnings = shown(image)
    assert warnings == ()
    assert codes(texture) == {1001: 10, 1002: 20, 1011: 110}


def test_a_file_that_is_broken_is_magenta(tmp_path):
    (tmp_path / "broken.png").write_bytes(b"\x89PNG\r\n\x1a\nbut nothing else")
    image = bpy.data.images.load(str(tmp_path / "broken.png"))
    texture, (warning,) = shown(image)
    assert "magenta" in warning
    assert np.shape(texture) == (3,) or texture.bitmap.pixels[:, 0, 0].tolist()[:3] == [1, 0, 1]


def test_a_packed_file_that_has_vanished_is_there(tmp_path):
    save(tmp_path / "grey.png", 70)
    image = bpy.data.images.load(str(tmp_path / "grey.png"))
    image.pack()
    (tmp_path / "grey.png").unlink()
    texture, warnings = shown(image)
    assert warnings == ()
    assert (texture.bitmap.pixels[:3] == 70).all()


def test_colour_spaces_are_converted_by_blender(tmp_path):
    """Grey of Rec.1886 is its code to the power of 2.4."""
    save(tmp_path / "grey.png", 128)
    image = bpy.data.images.load(str(tmp_path / "grey.png"))
    image.colorspace_settings.name = "Rec.1886"
    texture, warnings = shown(image)
    assert warnings == ()
    np.testing.assert_allclose(texture.bitmap.pixels[:3], (128 / 255) ** 2.4, rtol=2e-3)
    assert [i.name for i in bpy.data.images if i.name.startswith("Encoded")] == []


def test_a_movie_that_is_none_is_magenta(tmp_path):
    save(tmp_path / "grey.png", 70)
    image = bpy.data.images.load(str(tmp_path / "grey.png"))
    image.source = "MOVIE"
    (warning,) = shown(image)[1]
    assert "magenta" in warning and image.name in warning


@pytest.mark.parametrize(
    ("path", "expected"),
    [("//a/b_0001.png", "//a/b_0012.png"), ("/a1/b.png", "/a1/b.png"), ("C:\\x\\s2_1_left.jp2", "C:\\x\\s2_12_left.jp2"), ("007", "012")],
)
def test_the_last_number_of_a_name_is_the_frame(path, expected):
    assert images._numbered(path, 12) == expected


def test_one_image_is_one_bitmap_for_colour_and_alpha(tmp_path):
    material, tree, node = textured("Image", shader="ShaderNodeEmission")
    node.image = bpy.data.images.new("Both", 4, 4, alpha=True)
    shader = next(n for n in tree.nodes if n.type == "EMISSION")
    tree.links.new(node.outputs["Alpha"], blender.node_input(shader, "Strength"))
    o, _ = exported(material)
    images = [t for t in with_inner(o.materials[0].emission) if isinstance(t, ImageTexture)]
    assert {t.output for t in images} == {"uncut", "alpha"}
    assert len({t.bitmap for t in images}) == 1
