"""Keys for things that move, and what a moving bar looks like."""

import math

import numpy as np

from glanz.engine import OrthographicCamera
from glanz.tests import helpers as h

GLOW = h.lambert(0, "glow", 1.0)


def shifted(*steps):
    """Keys (K, 4, 4) at places."""
    return np.stack([h.affine(translation=step) for step in steps])


def turned(angles, centre=(0, 0, 0)):
    """Keys (K, 4, 4) that turn about z through `centre` [rad]."""
    centre = np.array(centre, float)
    keys = []
    for angle in angles:
        c, s = math.cos(angle), math.sin(angle)
        r = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        keys.append(h.affine(r, centre - r @ centre))
    return np.stack(keys)


def moving(o, keys):
    """The object `o`, carried by `keys` on top of where it stands."""
    return h.replaced(o, motion=keys @ o.world_from_object)


def trapezoid(x, travel, width):
    """The share of the time that a bar of width 1 covers x, averaged over pixels of `width`."""
    fine = x[:, None] + width * ((np.arange(64) + 0.5) / 64 - 0.5)
    covered = np.minimum(fine + 0.5, travel / 2) - np.maximum(fine - 0.5, -travel / 2)
    share = np.clip(covered, 0, None) / travel if travel else np.abs(fine) < 0.5
    return share.mean(axis=1)


def from_above(width, pixels=80):
    """A camera that looks down on a row of square `pixels` which are `width` wide together, along x."""
    return OrthographicCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0), height=width / pixels, aspect=pixels)


def is_share(row, truth, samples):
    """Whether each of about 80 pixels, hit by `truth` of its independent samples, shows that share: level ALPHA for all together."""
    return bool((np.abs(row - truth) <= 5.7 * np.sqrt(truth * (1 - truth) / samples + 1e-7)).all())
