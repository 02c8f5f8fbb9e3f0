"""Blender's images as the engine's, each loaded once for all textures that show it."""

import numpy as np

from ...engine import Bitmap
from .images import MAGENTA, frame_shown, has_codes_cut, note_missing, texels_of, tiles_of

_MAGENTA = Bitmap(name="missing", pixels=np.array(MAGENTA[:3], np.float32)[:, None, None])


class Bitmaps:
    """Engine values of the images met so far, at a `frame` of the scene.

    known  those of earlier exports
    asked  those of this one
    """

    def __init__(self, frame=1, known=None):
        self._frame = frame
        self._known = {} if known is None else known
        self.asked = {}

    def of(self, image, note, user=None, is_uncut=False):
        """The `Bitmap` of an image datablock, magenta where it is None or has no pixels, which `note` is told.

        user      the ImageUser of the node that shows it: of sequences and movies it says the frame
        is_uncut  its colours will be divided by alpha
        """
        frame = self.frame_of(image, user)
        key = image and (image.name_full, frame, is_uncut and has_codes_cut(image))
        found = self._once(key, lambda: _found(image, texels_of(image, frame, is_uncut)))
        if found is None:
            note_missing(note, image)
        return found or _MAGENTA

    def frame_of(self, image, user):
        """The number of the picture that an ImageUser shows of a sequence or movie; None: the image is but one."""
        return frame_shown(user, self._frame) if image and image.source in ("SEQUENCE", "MOVIE") else None

    def tiles(self, image, note, is_uncut=False):
        """((number, `Bitmap`), ...) of a tiled image without tiles that are missing, which `note` is told; () of others."""
        if not image or image.source != "TILED":
            return ()
        found = self._once(
            (image.name_full, "tiles", is_uncut and has_codes_cut(image)),
            lambda: tuple((number, _found(image, texels)) for number, texels in tiles_of(image, is_uncut)),
        )
        for number in (number for number, bitmap in found if bitmap is None):
            note_missing(note, image, number)
        return tuple(tile for tile in found if tile[1])

    def _once(self, key, make):
        if key not in self._known:
            self._known[key] = make()
        self.asked[key] = self._known[key]
        return self._known[key]


def _found(image, found):
    """What `texels_of` has found as a `Bitmap`, or None."""
    if found is None:
        return None
    texels, is_srgb = found
    return Bitmap(name=image.name, pixels=np.moveaxis(texels, 2, 0), is_srgb=is_srgb)
