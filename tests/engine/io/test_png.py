"""PNG files show the picture in sRGB."""

import numpy as np
import pytest

from glanz.engine import FileError, Image
from glanz.engine.io.png import srgb_from_linear, to_bytes, write_png

PIL = pytest.importorskip("PIL.Image", reason="Pillow is not installed")


def test_the_transfer_function_has_the_values_of_the_standard():
    # 0.0031308 is where the two parts meet; 0.214041 is the linear value of a middle grey of one half.
    linear = np.array([0, 0.0031308, 0.0031309, 0.2140411, 1])
    np.testing.assert_allclose(srgb_from_linear(linear), [0, 0.04044994, 0.04045, 0.5, 1], atol=2e-6)


def test_a_png_is_the_picture_with_straight_alpha_and_clipped(tmp_path):
    rgba = np.zeros((2, 3, 4), np.float32)
    rgba[0, 0] = (0.5, 0.0, 7.0, 1.0)
    rgba[0, 1] = (0.25, 0.25, 0.25, 0.5)
    rgba[1, 2] = (np.nan, np.inf, -np.inf, 1.0)
    rgba[1, 1] = (1e30, 0, 0, 1e-30)
    write_png(tmp_path / "a.png", Image(3, 2, {"Combined": rgba}))
    pixels = np.asarray(PIL.open(tmp_path / "a.png"))
    assert pixels.shape == (2, 3, 4)
    assert pixels[0, 0].tolist() == [188, 0, 255, 255]
    assert pixels[0, 1].tolist() == [188, 188, 188, 128]
    assert pixels[1, 2].tolist() == [0, 255, 0, 255]
    assert pixels[1, 1].tolist() == [255, 0, 0, 0]
    np.testing.assert_array_equal(pixels, to_bytes(rgba))


def test_an_unwritable_path_is_named(tmp_path):
    with pytest.raises(FileError, match="nowhere"):
        write_png(tmp_path / "nowhere" / "a.png", Image(1, 1, {"Combined": np.ones((1, 1, 4), np.float32)}))
