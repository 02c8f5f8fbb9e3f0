"""What to expect of a texture where nothing is known of the points: its values over many probes."""

import weakref

import numpy as np

PROBES = 256
"""Points of the unit cube; together their footprints cover it."""
_known = weakref.WeakKeyDictionary()


def average_of(texture):
    """The mean of a texture over uv, generated or object coordinates of the unit cube, (1,) or (3,) float64; no number counts as 0."""
    if texture not in _known:
        with np.errstate(all="ignore"):
            value = Probes().value(texture)
            _known[texture] = np.where(np.isfinite(value), value, 0).mean(axis=1, dtype=np.float64)
    return _known[texture]


class Probes:
    """Points to evaluate textures at, see `world.texturing.TexturePoints`, for which there is no scene."""
