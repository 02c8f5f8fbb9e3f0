"""Blender's images as the engine's, each loaded once for all textures that show it."""

import numpy as np

from ...engine import Bitmap
from .changes import identities
from .images import MAGENTA, frame_shown, has_codes_cut, linear_pixels, note_missing, texels_of, tiles_of
from .stamps import no_stamp

_MAGENTA = Bitmap(name="missing", pixels=np.array(MAGENTA[:3], np.float32)[:, None, None])


class Bitmaps:
    """Engine values of the images met so far, at a `frame` of the scene.

    stamp  (image, frame) -> what is the same for as long as its pixels are, None where that is for this export only
    """

    def __init__(self, frame=1, stamp=no_stamp):
        self._stamp = stamp
        self._known, self._wanted = {}, set()
        self.begin(frame)

    def begin(self, frame):
        """The same for an export at a `frame`, which begins."""
        self._frame, self._export = frame, object()
        return self

    def of(self, image, note, user=None, is_uncut=False):
        """The `Bitmap` of an image datablock, magenta where it is None or has no pixels, which `note` is told.

        user      the ImageUser of the node that shows it: of sequences and movies it says the frame
        is_uncut  its colours will be divided by alpha
        """
        frame = self.frame_of(image, user)
        cut = is_uncut and bool(image) and has_codes_cut(image)
        found = self._once(image, frame, cut, lambda: _found(image, texels_of(image, frame, is_uncut)))
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
            image,
            "tiles",
            is_uncut and has_codes_cut(image),
            lambda: tuple((number, _found(image, texels)) for number, texels in tiles_of(image, is_uncut)),
        )
        for number in (number for number, bitmap in found if bitmap is None):
            note_missing(note, image, number)
        return tuple(tile for tile in found if tile[1])

    def light(self, image, note, user):
        """The pixels (3, H, W) of an image as light, see `images.linear_pixels`; the rest is as of `of`."""
        frame = self.frame_of(image, user)
        found = self._once(image, frame, "light", lambda: linear_pixels(image, frame))
        if found is None:
            note_missing(note, image)
        return (_MAGENTA.pixels if found is None else found)[:3]

    def forget(self, images):
        """Forget those of `images`, see `changes`; None: all."""
        self._known = {key: value for key, value in self._known.items() if images is not None and images.isdisjoint(key[0])}

    def tidy(self):
        """Forget those that nobody has asked for since this was called the last time."""
        self._known = {key: value for key, value in self._known.items() if key in self._wanted}
        self._wanted = set()

    def _once(self, image, frame, kind, make):
        if image is None:
            return None
        stamp = self._stamp(image, frame)
        key = frozenset(identities(image)), image.name_full, frame, kind, self._export if stamp is None else stamp
        if key not in self._known:
            self._known[key] = make()
        self._wanted.add(key)
        return self._known[key]


def _found(image, found):
    """What `texels_of` has found as a `Bitmap`, or None."""
    if found is None:
        return None
    texels, is_srgb = found
    return Bitmap(name=image.name, pixels=np.moveaxis(texels, 2, 0), is_srgb=is_srgb)
