"""Environment textures as the engine's pictures of all directions."""

import numpy as np
from mathutils import Euler

from ...engine import EnvironmentMap
from .images import linear_pixels
from .nodes import input_by_identifier

_INTERPOLATIONS = {"Linear": "linear", "Closest": "closest"}


def export_environment(reader, node, strength):
    """The `EnvironmentMap` of an Environment Texture node, times the number `strength`."""
    pixels = linear_pixels(node.image, reader.findings, reader.owner)[:3]
    if node.interpolation not in _INTERPOLATIONS:
        reader.note(f"the interpolation {node.interpolation} of Environment Texture is rendered as Linear")
    if node.projection == "MIRROR_BALL":
        pixels = _unrolled(pixels)
    return EnvironmentMap(
        name=node.image.name if node.image else node.bl_label,
        pixels=pixels,
        world_from_map=_map_from_world(reader, input_by_identifier(node, "Vector")).T,
        strength=(float(strength),) * 3,
        interpolation=_INTERPOLATIONS.get(node.interpolation, "linear"),
    )


def _map_from_world(reader, socket):
    """The orthogonal matrix (3, 3) that the nodes behind a vector input turn directions with."""
    reader, _, output = reader.source(socket)
    if output is None:
        return np.eye(3)
    node = output.node
    if node.type == "TEX_COORD":
        if output.identifier != "Generated":
            reader.note(f"the coordinates {output.identifier} of the environment are rendered as Generated")
        return np.eye(3)
    if node.type != "MAPPING":
        reader.note(f"{node.bl_label} before the environment's picture is left out")
        return np.eye(3)
    before = reader.beyond(node)
    if before is None:
        return np.eye(3)
    return _orthogonal(reader, *_mapping(reader, node)) @ _map_from_world(before, input_by_identifier(node, "Vector"))


def _mapping(reader, node):
    """Rotation (3, 3), and the whole linear part (3, 3) of a Mapping node."""
    rotation = np.array(Euler(reader.colour(node, "Rotation")).to_matrix(), np.float64)
    scale = np.array(reader.colour(node, "Scale", (1.0, 1.0, 1.0)))
    kind = node.vector_type
    if kind in ("POINT", "TEXTURE") and any(reader.colour(node, "Location")):
        reader.note("Location of Mapping is left out for the environment: the picture is infinitely far away")
    if not scale.all():
        return (rotation.T if kind == "TEXTURE" else rotation), np.zeros((3, 3))
    if kind == "TEXTURE":
        return rotation.T, np.diag(1 / scale) @ rotation.T
    return rotation, rotation @ np.diag(1 / scale if kind == "NORMAL" else scale)


def _orthogonal(reader, rotation, linear):
    """`linear` (3, 3) without its size, which no direction has; `rotation` instead, with a note, where it also distorts."""
    size = np.cbrt(np.abs(np.linalg.det(linear)))
    if size > 0 and np.allclose(linear.T @ linear, size * size * np.eye(3), rtol=0, atol=1e-5 * size * size):
        return linear / size
    reader.note("Scale of Mapping is left out for the environment: it would distort the picture")
    return rotation


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
