"""Environment Texture nodes, and worlds that are but their picture."""

from dataclasses import replace

import numpy as np

from ...engine import Coordinates, EnvironmentMap, EnvironmentTexture
from .colours import terms_of, varies

_DIRECTION = Coordinates(source="position")
_INTERPOLATIONS = {"Linear": "linear", "Closest": "closest"}


def _environment(reader, node, output):
    pixels = reader.bitmaps.light(node.image, reader.note, node.image_user)
    if node.interpolation not in _INTERPOLATIONS:
        reader.note(f"the interpolation {node.interpolation} of Environment Texture is rendered as Linear")
    if node.projection == "MIRROR_BALL":
        pixels = _unrolled(pixels)
    name = node.image.name if node.image else node.bl_label
    picture = EnvironmentMap(name=name, pixels=pixels, interpolation=_INTERPOLATIONS.get(node.interpolation, "linear"))
    return EnvironmentTexture(picture, reader.vector(node, _DIRECTION))


TABLE = {"TEX_ENVIRONMENT": _environment}


def as_picture(radiance):
    """(radiance, `EnvironmentMap` or None): what a world's colour is without the one picture that it may show turned and scaled.

    A picture is chosen by texel, which finds more light than the samples of a texture.
    """
    terms = terms_of(radiance)
    if len(terms.textures) != 1 or varies(terms.factors[0]) or varies(terms.offset):
        return radiance, None
    (texture,), (factor,) = terms.textures, terms.factors
    if type(texture) is not EnvironmentTexture or not isinstance(texture.coordinates, Coordinates):
        return radiance, None
    matrix = np.array(texture.coordinates.matrix)
    size = np.cbrt(np.abs(np.linalg.det(matrix[:3, :3])))
    turn = matrix[:3, :3] / (size or 1)
    if matrix[:3, 3].any() or not np.allclose(turn.T @ turn, np.eye(3), rtol=0, atol=1e-5):
        return radiance, None
    strength = tuple(np.broadcast_to(np.asarray(factor, np.float64), 3).tolist())
    return tuple(np.broadcast_to(terms.offset, 3).tolist()), replace(texture.picture, world_from_map=turn.T, strength=strength)


def _unrolled(ball):
    """The picture of a mirror ball (3, H, W) as an equirectangular one of (3, 2 H, 4 H).

    The ball is seen along +y from far away: the direction d is mirrored at (d - y) / |d - y| (as in Cycles).
    """
    _, height, width = ball.shape
    finer = 2 * height
    theta = np.pi * (np.arange(finer)[:, None] + 0.5) / finer
    phi = np.pi * (1 - (np.arange(2 * finer) + 0.5) / finer)
    x, y, z = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)
    # |d - y| = sqrt(2 (1 - d_y)); towards +y, behind the ball, the picture ends in its rim.
    size = np.maximum(np.sqrt(2 * (1 - y)), np.finfo(np.float32).tiny)
    columns = np.clip(0.5 * (x / size + 1) * width - 0.5, 0, width - 1)
    rows = np.clip(0.5 * (1 - z / size) * height - 0.5, 0, height - 1)
    i, j = np.floor(columns).astype(int), np.floor(rows).astype(int)
    right, below = np.minimum(i + 1, width - 1), np.minimum(j + 1, height - 1)
    a, b = (columns - i).astype(np.float32), (rows - j).astype(np.float32)
    return (1 - b) * ((1 - a) * ball[:, j, i] + a * ball[:, j, right]) + b * ((1 - a) * ball[:, below, i] + a * ball[:, below, right])
