"""Scene values to one merged mesh, tables of materials and lights, and Embree's tree."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Columns
from ..errors import AccelError, SceneError
from ..maths.transforms import cofactors, flips_orientation, transform_points
from ..maths.vectors import cross, length
from ..scene.values import Material
from .accel import Accel
from .frame import Frame
from .lights import Lights
from .materials import Materials

FARTHEST = 1e12
"""In render space; Embree's robust test overflows from 3e12 on, and finds nothing."""
_BLACK = Material(name="none")


@dataclass(frozen=True, slots=True, eq=False)
class Triangles:
    """The merged mesh in render space; every array has one column per triangle.

    v0, e1, e2      (3, F) float32: first corner, and the edges to the second and third
    normal          (3, F) float32: geometric, unit, by winding
    extent          (F,) float32: the largest coordinate of the edges by magnitude
    corner_normals  (9, F) float32: shading normals of the three corners, one after the other; (9, 0): all flat
    material        (F,) int32, a row of `Materials`
    emitter         (F,) int32: which emissive triangle this is, -1 for none; (0,): none emits
    """

    v0: np.ndarray
    e1: np.ndarray
    e2: np.ndarray
    normal: np.ndarray
    extent: np.ndarray
    corner_normals: np.ndarray
    material: np.ndarray
    emitter: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class CompiledWorld:
    """What rays travel through. `background` (3, 1) float32 [W m^-2 sr^-1]; `emitters` index `lights` from `first_emitter` on."""

    frame: Frame
    accel: Accel
    triangles: Triangles
    materials: Materials
    lights: Lights
    first_emitter: int
    background: np.ndarray
    warnings: tuple


def compile_world(scene, bsdfs, smooth):
    """`scene` (validated) as a `CompiledWorld`.

    `bsdfs` are the lobes to make room for; `smooth` says whether shading normals are wanted. Raises SceneError
    where the geometry does not fit into memory.
    """
    warnings = []
    materials = list(dict.fromkeys(m for o in scene.objects for m in o.materials)) or [_BLACK]
    row = {material: i for i, material in enumerate(materials)}
    row.setdefault(_BLACK, len(materials))
    parts = [_place(o, row, smooth) for o in scene.objects if o.mesh.triangles.shape[1]]
    if any((part["material"] == len(materials)).any() for part in parts):
        materials.append(_BLACK)

    vertices = _concatenate([part["vertices"] for part in parts], (3, 0))
    counts = np.cumsum([0] + [part["vertices"].shape[1] for part in parts])
    indices = _concatenate([part["triangles"] + start for part, start in zip(parts, counts)], (3, 0)).astype(np.int32)
    frame = Frame.around(scene.camera.position, length(vertices - scene.camera.position[:, None]) if vertices.size else np.zeros(0))
    # Rounded once; from here on the rounded values are the geometry, for Embree and for everything else.
    with np.errstate(over="ignore"):
        vertices = frame.points(vertices).astype(np.float32)

    corners = vertices[:, indices]  # (3 coordinates, 3 corners, F)
    usable = np.isfinite(corners).all(axis=(0, 1)) & (np.abs(corners) < FARTHEST).all(axis=(0, 1))
    if not usable.all():
        warnings.append(f"{np.count_nonzero(~usable)} triangles are left out: a corner is not finite or too far away")
    exact = corners.astype(np.float64)
    e1, e2 = exact[:, 1] - exact[:, 0], exact[:, 2] - exact[:, 0]
    with np.errstate(over="ignore", invalid="ignore"):
        normal = cross(e1, e2)
        double_area = length(normal)
    # A triangle without an area is never hit: leaving it out changes no picture.
    keep = usable & (double_area > 0) & np.isfinite(double_area)
    if not keep.all():
        indices, e1, e2, normal, double_area = indices[:, keep], e1[:, keep], e2[:, keep], normal[:, keep], double_area[keep]
        corners = corners[:, :, keep]

    material = _concatenate([part["material"] for part in parts], (0,)).astype(np.int32)[keep]
    table = Materials.of(materials, bsdfs)
    emissive = np.nonzero(table.emission.any(axis=0)[material])[0] if material.size else np.zeros(0, np.int64)
    emitter = np.zeros(0, np.int32)
    if emissive.size:
        emitter = np.full(material.size, -1, np.int32)
        emitter[emissive] = np.arange(emissive.size)
    normal = (normal / double_area).astype(np.float32)
    triangles = Triangles(
        v0=np.ascontiguousarray(corners[:, 0]),
        e1=e1.astype(np.float32),
        e2=e2.astype(np.float32),
        normal=normal,
        extent=np.maximum(np.abs(e1), np.abs(e2)).max(axis=0, initial=0.0).astype(np.float32),
        corner_normals=_corner_normals(parts, keep, normal) if smooth else np.zeros((9, 0), np.float32),
        material=material,
        emitter=emitter,
    )
    light_triangles = Columns(
        v0=triangles.v0[:, emissive],
        e1=triangles.e1[:, emissive],
        e2=triangles.e2[:, emissive],
        normal=normal[:, emissive],
        extent=triangles.extent[emissive],
        area=(0.5 * double_area[emissive]).astype(np.float32),
        radiance=table.emission[:, material[emissive]],
    )
    try:
        accel = Accel(vertices, indices)
    except AccelError as error:
        raise SceneError(f"scene '{scene.name}': {error}") from error
    radius = float(np.abs(corners).max(initial=0.0)) / frame.scale or 1.0
    lights = Lights.of(scene.lights, light_triangles, frame, radius)
    background = np.array(scene.world.radiance, np.float32)[:, None]
    return CompiledWorld(frame, accel, triangles, table, lights, len(lights.cdf) - emissive.size, background, tuple(warnings))


def _place(o, row, smooth):
    """One object in world space, float64: its vertices, triangles, materials' rows, and corner normals if wanted."""
    mesh, matrix = o.mesh, o.world_from_object
    triangles = mesh.triangles
    corner = mesh.normal_indices
    if flips_orientation(matrix):  # a mirrored triangle keeps its front by turning its winding
        triangles = triangles[[0, 2, 1]]
        corner = corner[[0, 2, 1]]
    part = {"vertices": transform_points(matrix, mesh.vertices), "triangles": triangles}
    rows = np.array([row[m] for m in o.materials] or [row[_BLACK]], np.int32)
    if mesh.material_indices.size:
        part["material"] = rows[np.clip(mesh.material_indices, 0, len(rows) - 1)]
    else:
        part["material"] = np.full(triangles.shape[1], rows[0], np.int32)
    if smooth and mesh.is_smooth:
        normals = cofactors(matrix) @ mesh.normals.astype(np.float64)
        norm = length(normals)
        normals = (normals / np.where(norm > 0, norm, 1)).astype(np.float32)
        part["corner_normals"] = normals[:, corner].transpose(1, 0, 2).reshape(9, -1)
    return part


def _corner_normals(parts, keep, flat):
    # Filled with the geometric normal where a mesh is flat or its normal has no direction.
    result = np.tile(flat, (3, 1))
    column = np.cumsum(keep) - 1
    start = 0
    for part in parts:
        count = part["triangles"].shape[1]
        if "corner_normals" in part:
            kept = np.nonzero(keep[start : start + count])[0]
            given = part["corner_normals"][:, kept]
            at = column[start + kept]
            for corner in range(0, 9, 3):
                valid = np.isfinite(given[corner : corner + 3]).all(axis=0) & given[corner : corner + 3].any(axis=0)
                result[corner : corner + 3, at[valid]] = given[corner : corner + 3, valid]
        start += count
    return result


def _concatenate(arrays, empty):
    return np.concatenate(arrays, axis=-1) if arrays else np.zeros(empty)
