"""Where patterns are looked up, and with which numbers."""

import dataclasses

import numpy as np

MOST_DETAIL = 15
"""Octaves beyond the first that patterns have at most."""


def placed(at, coordinates, scale=1.0, w=0.0, dimensions=3):
    """The points p (D, N) of a pattern in so many `dimensions`, and None or half the extent (N,) of their footprints.

    One dimension is `w`, four are the three of `coordinates` and w, all times `scale`: inputs, see `Points.value`.
    Scales that vary are taken as constant over a footprint, and w as well.
    """
    (scale,) = numbers(at, scale)
    if dimensions == 1:
        return numbers(at, w)[0][None] * scale, None
    p, axes = at.look_up(coordinates)
    p = p[:dimensions] * scale
    if dimensions == 4:
        p = np.concatenate((p, np.broadcast_to(numbers(at, w)[0] * scale, p[:1].shape)))
    if axes is None:
        return p, None
    # Both half-axes of the footprint: half of its longest extent.
    squares = [x * x for axis in axes for x in axis[:dimensions]]
    return p, np.sqrt(sum(squares[1:], squares[0])) * np.abs(scale)


def numbers(at, *inputs):
    """Inputs that are numbers, as float32 (1,) or (N,) each; of three numbers, which may stand in their place, the first."""
    return [at.value(x)[0] for x in inputs]


def octaves(detail):
    """`detail` (N,) within 0 and MOST_DETAIL; what is no number counts as 0."""
    return np.minimum(np.fmax(detail, np.float32(0)), np.float32(MOST_DETAIL))


def shared_key(texture, but):
    """What textures have in common that differ in the field `but` alone, for `Points.once`."""
    return (type(texture), *(getattr(texture, field.name) for field in dataclasses.fields(texture) if field.name != but))
