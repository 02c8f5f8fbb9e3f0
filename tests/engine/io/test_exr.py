"""EXR files hold exactly what was rendered, and appear whole or not at all."""

import resource

import numpy as np
import pytest

from glanz.engine import FileError, Image, write_exr
from glanz.engine.io.exr import read_exr, read_exr_metadata


@pytest.fixture
def image():
    rng = np.random.default_rng(1)
    passes = {name: rng.standard_normal((7, 5, n)).astype(np.float32) for name, n in (("Combined", 4), ("Depth", 1), ("Normal", 3))}
    passes["Combined"][0, 0] = (np.inf, np.nan, -0.0, 1e-42)
    return Image(5, 7, passes, {"glanz.samples": "64", "note": "Käse"})


def test_an_exr_gives_back_every_bit_of_every_pass(tmp_path, image):
    write_exr(tmp_path / "a.exr", image)
    channels = read_exr(tmp_path / "a.exr")
    wanted = {
        **dict(zip("RGBA", np.moveaxis(image.passes["Combined"], 2, 0))),
        "Depth.Z": image.passes["Depth"][..., 0],
        **{f"Normal.{axis}": image.passes["Normal"][..., i] for i, axis in enumerate("XYZ")},
    }
    assert channels.keys() == wanted.keys()
    for name, values in wanted.items():
        assert channels[name].dtype == np.float32
        assert channels[name].tobytes() == values.tobytes(), name


def test_an_exr_tells_how_it_was_made(tmp_path, image):
    write_exr(tmp_path / "a.exr", image)
    assert read_exr_metadata(tmp_path / "a.exr").items() >= image.metadata.items()


def test_the_image_is_not_touched_by_writing_it(tmp_path, image):
    before = {name: values.copy() for name, values in image.passes.items()}
    write_exr(tmp_path / "a.exr", image)
    for name, values in before.items():
        assert isinstance(image.passes[name], np.ndarray) and image.passes[name].tobytes() == values.tobytes()


@pytest.mark.parametrize("name", ["nowhere/a.exr", "folder", "a\0.exr"])
def test_an_unwritable_path_is_named_and_nothing_is_left(tmp_path, image, name):
    (tmp_path / "folder").mkdir()
    with pytest.raises(FileError, match="cannot write"):
        write_exr(tmp_path / name, image)
    assert [p.name for p in tmp_path.iterdir()] == ["folder"]


@pytest.mark.parametrize("limit", [0, 100, 700, 1000])
def test_a_full_disk_leaves_the_old_file_and_no_other(tmp_path, image, limit):
    target = tmp_path / "a.exr"
    write_exr(target, image)
    old = target.read_bytes()
    assert len(old) > 1000
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, hard))
    try:
        with pytest.raises(FileError, match=r"a\.exr"):
            write_exr(target, image)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert target.read_bytes() == old
    assert list(tmp_path.iterdir()) == [target]


def test_reading_what_is_no_exr_is_a_file_error(tmp_path):
    (tmp_path / "a.exr").write_bytes(b"no picture")
    for name, cause in (("a.exr", "not an OpenEXR file"), ("b.exr", "No such file"), (".", "directory")):
        with pytest.raises(FileError, match=cause):
            read_exr(tmp_path / name)


def test_a_link_keeps_leading_to_the_file(tmp_path, image):
    (tmp_path / "link.exr").symlink_to(tmp_path / "a.exr")
    write_exr(tmp_path / "link.exr", image)
    assert (tmp_path / "link.exr").is_symlink()
    assert read_exr(tmp_path / "a.exr").keys() >= set("RGBA")
