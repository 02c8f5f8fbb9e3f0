"""Blender's images as the engine's, each loaded once for all textures that show it."""

import numpy as np

from ...engine import Bitmap
from .findings import Findings
from .images import MISSING, frame_shown, has_codes_cut, texels_of, tiles_of

_MAGENTA = Bitmap(name="missing", pixels=np.array(MISSING[:3], np.float32)[:, None, None])


class Bitmaps:
    """Engine values of the images met so far, at a `frame` of the scene.

    known  those of earlier exports, each with what there was to note
    """

    def __init__(self, findings, frame=1, known=None):
        self._findings = findings
        self._frame = frame
        self._known = {} if known is None else known

    def of(self, image, owner, user=None, is_uncut=False):
        """The `Bitmap` of an image datablock, magenta where it is None or has no pixels; notes are for `owner`.

        user      the ImageUser of the node that shows it: of sequences and movies it says the frame
        is_uncut  its colours will be divided by alpha
        """
        frame = self.frame_of(image, user)
        key = image and (image.name_full, frame, is_uncut and has_codes_cut(image))
        return self._once(key, lambda findings: _read(image, findings, owner, frame, is_uncut))

    def frame_of(self, image, user):
        """The number of the picture that an ImageUser shows of a sequence or movie; None: the image is but one."""
        return frame_shown(user, self._frame) if image and image.source in ("SEQUENCE", "MOVIE") else None

    def tiles(self, image, owner, is_uncut=False):
        """((number, `Bitmap`), ...) of a tiled image; () of others."""
        if not image or image.source != "TILED":
            return ()
        return self._once(
            (image.name_full, "tiles", is_uncut and has_codes_cut(image)),
            lambda findings: tuple((number, _bitmap(image, *found)) for number, found in tiles_of(image, findings, owner, is_uncut)),
        )

    def _once(self, key, make):
        if key not in self._known:
            notes = Findings()
            self._known[key] = make(notes), notes
        value, notes = self._known[key]
        self._findings.add(notes)
        return value


def _read(image, findings, owner, frame, is_uncut):
    found = texels_of(image, findings, owner, frame, is_uncut)
    return _MAGENTA if found is None else _bitmap(image, *found)


def _bitmap(image, texels, is_srgb):
    return Bitmap(name=image.name, pixels=np.moveaxis(texels, 2, 0), is_srgb=is_srgb)
