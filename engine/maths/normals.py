"""Normals of meshes from their triangles alone."""

import numpy as np

from ..constants import PI
from .vectors import cross, dot, length


def area_normals(vertices, triangles):
    """For each of triangles (3, F) its normal times twice its area, (3, F) float64; 0 where it has none, or is not finite."""
    a, b, c = np.asarray(vertices, np.float64)[:, triangles].transpose(1, 0, 2)
    with np.errstate(invalid="ignore", over="ignore"):
        twice = cross(b - a, c - a)
    return np.where(np.isfinite(twice).all(axis=0), twice, 0)


def vertex_normals(vertices, triangles, angle):
    """Unit normals (3, K) float64, and (3, F) which of them each corner takes: the sum of those of its faces, weighted by area.

    Faces that meet at more than `angle` [rad] have an edge between them, across which nothing is added: a vertex has as
    many normals as edges divide its faces into. With an angle of pi it has one.
    """
    face = area_normals(vertices, triangles)
    if angle >= PI:
        corner_groups = triangles
    else:
        corner_groups = components(triangles.size, *_joined_corners(triangles, face, angle)).reshape(triangles.shape)
    _, first, group = np.unique(corner_groups, return_index=True, return_inverse=True)
    group = group.ravel()
    corners = np.tile(face, 3)
    total = np.stack([np.bincount(group, row) for row in corners])
    size, area = length(total), np.bincount(group, length(corners))
    # Faces that cancel leave rounding, of as many terms as there are: one of them decides.
    is_void = size <= np.finfo(np.float64).eps * np.bincount(group) * area
    total[:, is_void] = corners[:, first[is_void]]
    size = length(total)
    # A triangle without an area is never hit.
    total[2, size == 0] = 1
    return total / np.where(size > 0, size, 1), group.reshape(triangles.shape)


def components(count, a, b):
    """The connected components of nodes 0 to count - 1 with edges a, b (E,): for each node the least one that it is joined to."""
    label = np.arange(count)
    while True:
        # Each root is hung below the least one that an edge joins it to (Shiloach and Vishkin 1982), then all paths are cut short.
        root_a, root_b = label[a], label[b]
        if np.array_equal(root_a, root_b):
            return label
        np.minimum.at(label, np.maximum(root_a, root_b), np.minimum(root_a, root_b))
        while not np.array_equal(label, shorter := label[label]):
            label = shorter


def _joined_corners(triangles, face, angle):
    """Pairs of corners, numbered as `triangles.ravel()`, that share a vertex and an edge that is not sharp: two arrays."""
    count = triangles.shape[1]
    corner = np.arange(triangles.size).reshape(triangles.shape)
    begin, end = triangles.ravel(), np.roll(triangles, -1, axis=0).ravel()
    at_begin, at_end = corner.ravel(), np.roll(corner, -1, axis=0).ravel()
    is_up = begin < end
    at_low, at_high = np.where(is_up, at_begin, at_end), np.where(is_up, at_end, at_begin)
    edge = np.minimum(begin, end).astype(np.int64) * (int(triangles.max(initial=0)) + 1) + np.maximum(begin, end)
    order = np.argsort(edge, kind="stable")
    meets = edge[order[1:]] == edge[order[:-1]]
    one, other = order[:-1][meets], order[1:][meets]
    unit = face / np.maximum(length(face), np.finfo(np.float64).tiny)
    between = np.arccos(np.clip(dot(unit[:, one % count], unit[:, other % count]), -1, 1))
    one, other = one[between <= angle], other[between <= angle]
    return np.concatenate((at_low[one], at_high[one])), np.concatenate((at_low[other], at_high[other]))
