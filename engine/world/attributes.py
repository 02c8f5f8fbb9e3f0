"""What meshes bring for textures to be looked up at: points that vary linearly over each triangle."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Attribute:
    """One attribute of the triangles of a world that ask for it; elsewhere it is 0.

    row      (F,) intp: a column of `corners` for each triangle
    corners  (9, S) float32: the value at the first corner, and the differences to those at the second and third
    """

    row: np.ndarray
    corners: np.ndarray

    def at(self, prim, u, v):
        """The value (3, N) at places u, v of triangles, and its changes along u and v, (3, N) each."""
        corner, along_u, along_v = self.corners.take(self.row.take(prim), axis=1).reshape(3, 3, -1)
        corner += u * along_u
        corner += v * along_v
        return corner, along_u, along_v


def compile_attributes(parts, keep, material, wanted):
    """({key: Attribute}, warnings) for the triangles `keep` (F,) of all `parts`, whose materials are `material` (F,).

    `wanted` is {key: rows of the materials that ask for it}; keys as in `Coordinates.attribute`.
    """
    found, warnings = {}, []
    ends = np.cumsum([part.owner.size for part in parts])
    part_of = np.searchsorted(ends, keep, side="right")
    for key, rows in wanted.items():
        asks = np.isin(material, list(rows))
        row, pieces, count = np.zeros(keep.size, np.intp), [np.zeros((9, 1), np.float32)], 1
        for i, part in enumerate(parts):
            here = np.nonzero(asks & (part_of == i))[0]
            if not here.size or (corners := _corners(part, keep[here] - (ends[i] - part.owner.size), *key)) is None:
                continue
            row[here] = count + np.arange(here.size)
            count += here.size
            pieces.append(corners)
        corners = np.concatenate(pieces, axis=1)
        lost = np.count_nonzero(~np.isfinite(corners).all(axis=0))
        if lost:
            warnings.append(f"{lost} triangles have {key[0]} coordinates that are not finite, which count as 0")
            corners = np.nan_to_num(corners, nan=0, posinf=0, neginf=0)
        found[key] = Attribute(row, corners)
    return found, tuple(warnings)


def _corners(part, triangles, source, layer):
    """(9, N) of `triangles` (N,) of a part, or None where its mesh lacks the attribute."""
    mesh = part.mesh
    instance, face = np.divmod(triangles, mesh.triangles.shape[1])
    if source == "uv":
        if layer not in ("", *mesh.uv_layers) or not mesh.uv_layers:
            return None
        u, v = mesh.uvs[mesh.uv_layers.index(layer) if layer else 0]
        values, indices = np.stack((u, v, np.zeros_like(u))), mesh.uv_indices
    else:
        values, indices = generated(mesh) if source == "generated" else mesh.vertices, mesh.triangles
    indices = indices.take(face, axis=1).astype(np.intp)
    # As placed: mirrored instances have their winding turned.
    turned = part.mirrored.take(instance)
    indices[1:, turned] = indices[:0:-1, turned]
    with np.errstate(over="ignore", invalid="ignore"):
        corners = values.astype(np.float32).take(indices, axis=1).transpose(1, 0, 2)
        return np.concatenate((corners[0], corners[1] - corners[0], corners[2] - corners[0]))


def generated(mesh):
    """Generated coordinates (3, V): those of the mesh, or else its bounding box as the unit cube; 1/2 where that is flat."""
    if mesh.generated.shape[1]:
        return mesh.generated
    vertices = mesh.vertices.astype(np.float64)
    low, size = vertices.min(axis=1, keepdims=True), np.ptp(vertices, axis=1, keepdims=True)
    return np.where(size > 0, (vertices - low) / np.where(size > 0, size, 1), 0.5)
