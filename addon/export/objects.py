"""Everything that stands in the scene: meshes and lights, each instance placed in the world."""

from dataclasses import dataclass

import bpy
import numpy as np

from ...engine import GlanzError, Object, SceneError
from .light import export_light
from .material import export_material
from .mesh import export_mesh

POLL_EVERY = 256
"""Instances between two questions whether to stop."""
LARGEST = 1e30
"""Blender cuts infinite coordinates off at 3.4e38; what is beyond this is no place."""

_NOT_RENDERED = {
    "CURVES": "hair curves are not rendered",
    "POINTCLOUD": "point clouds are not rendered",
    "VOLUME": "volumes are not rendered",
    "GPENCIL": "grease pencil is not rendered",
    "GREASEPENCIL": "grease pencil is not rendered",
}
_RAY_VISIBILITY = ("visible_camera", "visible_diffuse", "visible_glossy", "visible_transmission", "visible_shadow")


@dataclass(frozen=True)
class _Placed:
    """An instance before its matrix is checked: who it is, what it is made of."""

    name: str
    mesh: object
    materials: tuple


class ObjectExport:
    """Goes once through the instances of `depsgraph`; afterwards `objects` and `lights` are engine values.

    Meshes are shared by data-block, so ten thousand instances cost one mesh. `material_override`, if any, replaces all
    materials. `check` is called now and then and may raise to stop. Raises SceneError naming the object that failed.
    """

    def __init__(self, depsgraph, findings, material_override=None, check=lambda: None):
        self.findings = findings
        self.override = material_override
        self.lights = []
        self._depsgraph = depsgraph
        self._meshes = {}
        self._materials = {}
        self._parts = {}
        placed, matrices = [], []
        for i, instance in enumerate(depsgraph.object_instances):
            if i % POLL_EVERY == 0:
                check()
            try:
                part = self._part_of(instance)
            except GlanzError:
                raise
            except Exception as error:
                raise SceneError(f"object '{instance.object.name}' cannot be exported: {type(error).__name__}: {error}") from error
            if part:
                placed.append(part)
                matrices.append(np.array(instance.matrix_world, np.float64))
        self.objects = self._placed_objects(placed, matrices)

    def _part_of(self, instance):
        """The `_Placed` mesh of an instance, or None; lights go to `lights` at once."""
        ob = instance.object
        # Text, curves and metaballs come twice: as themselves, and as an instance whose data is a mesh.
        if isinstance(ob.data, bpy.types.Mesh):
            return self._mesh_part(ob) if instance.show_self else None
        if ob.type == "LIGHT":
            self._add_light(ob, np.array(instance.matrix_world, np.float64))
        elif ob.type in _NOT_RENDERED:
            self.findings.note(_NOT_RENDERED[ob.type], f"object '{ob.name}'")
        return None

    def _add_light(self, ob, matrix):
        if not is_placed(matrix[None])[0]:
            self.findings.note("the transform is not finite, so it is left out", f"light '{ob.name}'")
            return
        light = export_light(ob, matrix, self.findings)
        if light is not None:
            self.lights.append(light)

    def _mesh_part(self, ob):
        # Instances are temporary copies: only the original and the data tell which object it is.
        key = (ob.original.as_pointer(), ob.data.as_pointer())
        if key not in self._parts:
            self._note_ignored(ob)
            mesh = self._mesh(ob.data, ob.name)
            self._parts[key] = _Placed(ob.name, mesh, self._materials_of(ob)) if mesh.triangles.shape[1] else None
        return self._parts[key]

    def _mesh(self, data, name):
        key = data.as_pointer()
        if key not in self._meshes:
            self._meshes[key] = export_mesh(data, data.name or name)
        return self._meshes[key]

    def _materials_of(self, ob):
        # Slots, not the mesh's own list: they know which materials are linked to the object instead.
        materials = [slot.material for slot in ob.material_slots] or [None]
        return tuple(self._material(self.override or material) for material in materials)

    def _material(self, material):
        key = material.as_pointer() if material else None
        if key not in self._materials:
            self._materials[key] = export_material(material, self.findings)
        return self._materials[key]

    def _note_ignored(self, ob):
        name = f"object '{ob.name}'"
        if not all(getattr(ob, flag) for flag in _RAY_VISIBILITY):
            self.findings.note("ray visibility is ignored, everything sees the object", name)
        if ob.is_holdout or ob.is_shadow_catcher:
            self.findings.note("holdouts and shadow catchers are rendered as ordinary objects", name)
        for system in ob.particle_systems:
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self.findings.note("hair particles are not rendered", name)

    def _placed_objects(self, placed, matrices):
        if not placed:
            return ()
        matrices = np.stack(matrices)
        finite = is_placed(matrices)
        visible = finite & has_faces(matrices)
        for part, is_finite, is_visible in zip(placed, finite, visible, strict=True):
            if not is_visible:
                cause = "the scale leaves no surface" if is_finite else "the transform is not finite"
                self.findings.note(f"{cause}, so it is left out", f"object '{part.name}'")
        return tuple(
            Object(name=part.name, mesh=part.mesh, world_from_object=matrix, materials=part.materials)
            for part, matrix, is_visible in zip(placed, matrices, visible, strict=True)
            if is_visible
        )


def is_placed(matrices):
    """(N,): whether matrices (N, 4, 4) are finite and within what single precision can place."""
    return (np.abs(matrices) < LARGEST).all(axis=(1, 2))


def has_faces(matrices):
    """(N,): whether the linear parts of matrices (N, 4, 4) leave an area to at least some face: rank 2 or 3."""
    with np.errstate(all="ignore"):
        x, y, z = np.moveaxis(matrices[:, :3, :3], 2, 0)
        return np.any([np.cross(a, b).any(axis=1) for a, b in ((x, y), (y, z), (z, x))], axis=0)
