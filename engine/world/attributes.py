"""What meshes and objects bring for textures to look up: values that vary linearly over each triangle, and values of objects."""

from dataclasses import dataclass

import numpy as np

from ..arrays import gather
from ..errors import SceneWarning
from ..maths.murmur import id_of
from ..maths.tangents import corner_tangents, flat_normals

OF_OBJECTS = ("value", "world_from_object", "object_from_world", "name of object", "name of asset", "shift")
"""The sources of attributes that are the same all over an object."""


@dataclass(frozen=True, slots=True, eq=False)
class Attribute:
    """One attribute, of C components, of the triangles of a world that ask for it; elsewhere it is 0.

    row      (F,) intp: a column of `corners` for each triangle
    corners  (3 C, S) float32: the value at the first corner, and the differences to those at the second and third
    """

    row: np.ndarray
    corners: np.ndarray

    def is_there(self, prim):
        """Whether the meshes of triangles have it, (N,) bool."""
        return gather(self.row, prim) > 0

    def at(self, prim, u, v):
        """The value (C, N) at places u, v of triangles, and its changes along u and v, (C, N) each."""
        corner, along_u, along_v = gather(self.corners, gather(self.row, prim)).reshape(3, len(self.corners) // 3, -1)
        corner += u * along_u
        corner += v * along_v
        return corner, along_u, along_v


@dataclass(frozen=True, slots=True, eq=False)
class OfObject:
    """One value, of C components, of each object.

    owner  (F,) intp: the object of each triangle
    table  (C, O) float32
    """

    owner: np.ndarray
    table: np.ndarray

    def at(self, prim, u, v):
        """See `Attribute.at`; it does not change along u and v."""
        none = np.zeros((len(self.table), 1), np.float32)
        return self.table.take(self.owner.take(prim), axis=1), none, none


def compile_attributes(parts, keep, material, wanted, objects, owner):
    """({key: `Attribute` or `OfObject`}, warnings) for the triangles `keep` (F,) of all `parts`.

    Their materials are `material` (F,), and they belong to the `objects` of the scene `owner` (F,). `wanted` is {key: rows of
    the materials that ask for it}. A key is (source, name):

    uv, generated, object  (3,) as in `Coordinates`
    attribute              (3,) a `MeshAttribute` as a colour or vector: one number counts three times
    number, alpha          (1,) the same as a number, the mean of what has three components; its alpha, 1 where it has none
    colour alpha           (1,) its alpha, 0 where a mesh has no such attribute
    parametric             (3,) the shares of the first and the second corner, and 0
    normal                 (3,) of the corners in object space, as they vary between them: not unit
    tangent                (4,) the tangent of a uv layer in object space, and the side of the bitangent, see `maths.tangents`
    value                  (4,) of `Object.values`, or the location of the object
    world_from_object, object_from_world  (12,) the rows of the matrix
    shift                                 (12,) what is added to world_from_object one frame "before" or "after"
    change                                (3,) what is added to the vertices then, in object space
    name of object, name of asset         (1,) the number of the name, see `maths.murmur`
    """
    found, warnings = {}, []
    ends = np.cumsum([part.owner.size for part in parts])
    part_of = np.searchsorted(ends, keep, side="right")
    for key, rows in wanted.items():
        if key[0] in ("position", "camera"):
            # Points know where they are.
            continue
        if key[0] in OF_OBJECTS:
            found[key] = OfObject(owner, _of_objects(objects, *key))
            continue
        asks = np.isin(material, list(rows))
        empty = np.zeros((3 * _COMPONENTS.get(key[0], 3), 1), np.float32)
        row, pieces, count = np.zeros(keep.size, np.intp), [empty], 1
        for i, part in enumerate(parts):
            here = np.nonzero(asks & (part_of == i))[0]
            if not here.size or (corners := _corners(part, keep[here] - (ends[i] - part.owner.size), *key)) is None:
                continue
            row[here] = count + np.arange(here.size)
            count += here.size
            pieces.append(corners)
        corners = np.concatenate(pieces, axis=1)
        lost = np.nonzero(~np.isfinite(corners).all(axis=0))[0]
        if lost.size:
            what = f"{key[0]} coordinates that are not finite count as 0"
            warnings += [SceneWarning(what, "object", objects[i].name) for i in np.unique(owner[np.isin(row, lost)])]
            corners = np.nan_to_num(corners, nan=0, posinf=0, neginf=0)
        found[key] = Attribute(row, corners)
    return found, tuple(warnings)


_SIZES = {"value": 4, "name of object": 1, "name of asset": 1}
_BESIDE = {"before": 0, "after": 1}
_COMPONENTS = {"number": 1, "alpha": 1, "colour alpha": 1, "tangent": 4}


def _of_objects(objects, source, name):
    if source == "value":
        rows = [dict(o.values).get(name, (*o.world_from_object[:3, 3], 1) if name == "location" else (0, 0, 0, 0)) for o in objects]
    elif source == "shift":
        rows = [(o.beside[_BESIDE[name]] - o.world_from_object)[:3].ravel() if len(o.beside) else np.zeros(12) for o in objects]
    elif source.startswith("name of"):
        rows = [(id_of((source.endswith("asset") and o.asset) or o.name),) for o in objects]
    else:
        matrices = (o.world_from_object for o in objects)
        # What is flattened has no inverse, but one that leads back into its plane.
        rows = [(m if source == "world_from_object" else np.linalg.pinv(m))[:3].ravel() for m in matrices]
    return np.array(rows, np.float32).T.reshape(_SIZES.get(source, 12), -1)


def _corners(part, triangles, source, name):
    """(3 C, N) of `triangles` (N,) of a part, or None where its mesh lacks the attribute."""
    mesh = part.mesh
    found = _values(mesh, source, name)
    if found is None:
        return None
    values, indices = found
    instance, face = np.divmod(triangles, mesh.triangles.shape[1])
    indices = indices.take(face, axis=1).astype(np.intp)
    # As placed: mirrored instances have their winding turned.
    turned = part.mirrored.take(instance)
    indices[1:, turned] = indices[:0:-1, turned]
    with np.errstate(over="ignore", invalid="ignore"):
        corners = values.astype(np.float32).take(indices, axis=1).transpose(1, 0, 2)
        return np.concatenate((corners[0], corners[1] - corners[0], corners[2] - corners[0]))


def _values(mesh, source, name):
    """Values (C, K) of a mesh, and which of them (3, F) its corners take; None where it has none."""
    if source == "generated":
        return generated(mesh), mesh.triangles
    if source == "object":
        return mesh.vertices, mesh.triangles
    if source == "change":
        return (mesh.beside[_BESIDE[name]] - mesh.vertices, mesh.triangles) if len(mesh.beside) else None
    if source == "parametric":
        return np.diag((1, 1, 0)), np.repeat(np.arange(3)[:, None], mesh.triangles.shape[1], axis=1)
    if source == "normal":
        return (mesh.normals, mesh.normal_indices) if mesh.is_smooth else flat_normals(mesh)
    if source in ("uv", "tangent"):
        if name not in ("", *mesh.uv_layers) or not mesh.uv_layers:
            return None
        u, v = mesh.uvs[mesh.uv_layers.index(name) if name else 0]
        if source == "uv":
            return np.stack((u, v, np.zeros_like(u))), mesh.uv_indices
        return corner_tangents(mesh, np.stack((u, v)))
    attribute = next((a for a in mesh.attributes if a.name == name), None)
    if attribute is None:
        # One that is missing is a number: 0, wholly there.
        return (np.ones((1, 1)), np.zeros_like(mesh.triangles)) if source == "alpha" else None
    indices = attribute.indices if attribute.indices.size else mesh.triangles
    return _as_kind(attribute.values, source), indices


def _as_kind(values, source):
    """Values (C, K) of an attribute as the components (3, K) or (1, K) that are asked for."""
    if source.endswith("alpha"):
        return values[3:] if len(values) == 4 else np.ones_like(values[:1])
    if source == "number":
        return values[:1] if len(values) < 3 else values[:3].mean(axis=0, keepdims=True)
    if len(values) == 1:
        return np.repeat(values, 3, axis=0)
    return values[:3] if len(values) > 2 else np.concatenate((values, np.zeros_like(values[:1])))


def generated(mesh):
    """Generated coordinates (3, V): those of the mesh, or else its bounding box as the unit cube; 1/2 where that is flat."""
    if mesh.generated.shape[1]:
        return mesh.generated
    vertices = mesh.vertices.astype(np.float64)
    low, size = vertices.min(axis=1, keepdims=True), np.ptp(vertices, axis=1, keepdims=True)
    return np.where(size > 0, (vertices - low) / np.where(size > 0, size, 1), 0.5)
