"""Pictures are held once, texel by texel, and tell what is wrong with them."""

import numpy as np
import pytest

from glanz.engine import Bitmap, SceneError
from glanz.tests import helpers as h


def texels(dtype, size=(4, 5)):
    rng = np.random.default_rng(1)
    return rng.integers(0, 256, (*size, 4)).astype(np.uint8) if dtype == np.uint8 else rng.random((*size, 4), np.float32)


@pytest.mark.parametrize("dtype", [np.uint8, np.float32])
def test_texels_that_lie_together_are_not_copied(dtype):
    """Of a picture of 8192 x 8192 there is one copy of its bytes, a quarter of a gigabyte; its mip maps are a third of it in floats."""
    whole = texels(dtype)
    bitmap = Bitmap(name="b", pixels=np.moveaxis(whole, 2, 0))
    assert np.shares_memory(bitmap.pixels, whole)
    assert np.shares_memory(bitmap.pyramid.base, whole)
    assert np.shares_memory(bitmap.uncut.base, whole)


@pytest.mark.parametrize("channels", [3, 4])
@pytest.mark.parametrize("dtype", [np.uint8, np.float32])
def test_pixels_come_back_as_they_were_given(channels, dtype):
    pixels = np.ascontiguousarray(np.moveaxis(texels(dtype), 2, 0)[:channels])
    bitmap = Bitmap(name="b", pixels=pixels)
    assert h.same_bits(np.ascontiguousarray(bitmap.pixels), pixels)
    assert not bitmap.pixels.flags.writeable
    alpha = bitmap.pyramid.base[:, 3]
    whole = 255 if dtype == np.uint8 else 1
    assert (alpha == (pixels[3].ravel() if channels == 4 else whole)).all()


@pytest.mark.parametrize("shape", [(2, 4, 4), (3, 4), (5, 1, 1), (3, 0, 2), (4, 0, 2)])
def test_other_shapes_are_refused_by_name(shape):
    with pytest.raises(SceneError, match="'odd'"):
        Bitmap(name="odd", pixels=np.zeros(shape, np.float32))


def test_numbers_that_are_none_are_known():
    assert Bitmap(name="b", pixels=texels(np.uint8).transpose(2, 0, 1)).is_finite
    holes = texels(np.float32)
    holes[1, 1, 1] = np.nan
    assert not Bitmap(name="b", pixels=np.moveaxis(holes, 2, 0)).is_finite
