"""Everything that stands in the scene: meshes and lights, each instance placed in the world."""

from dataclasses import dataclass, replace
from functools import cached_property

import bpy
import numpy as np

from ...engine import RAY_KINDS, GlanzError, Object, SceneError
from .findings import IGNORED, MISSING
from .kept import Kept
from .light import Emissions, export_light
from .material import export_material, held_out, is_volume_only
from .mesh import export_mesh, mesh_of
from .missing import note_missing
from .motion import STILL
from .object_values import object_values
from .sights import sights_of

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
_OF_OBJECTS = ("value", "world_from_object", "object_from_world", "position", "camera")
"""What materials ask of objects, not of their meshes."""


@dataclass(frozen=True)
class _Placed:
    """An instance before its matrix is checked: who it is, what it has, the names of the values it is asked for, and more of `Object`.

    One that is held out is two: what the camera sees is `held`.
    """

    name: str
    mesh: object
    materials: tuple
    asked: tuple
    more: dict
    hidden_from: tuple = ()

    @cached_property
    def held(self):
        """What the camera sees of it where it is held out."""
        return replace(self, materials=tuple(map(held_out, self.materials)), hidden_from=RAY_KINDS[1:])


def export_objects(
    depsgraph,
    findings,
    bitmaps,
    material_override=None,
    check=lambda: None,
    tracks=STILL,
    kept=None,
    is_shown=lambda ob: True,
    asked=(),
    aovs=(),
):
    """(objects, lights): engine values for every instance of `depsgraph`, tuples.

    Meshes are shared by data-block, so ten thousand instances cost one mesh; images are by `bitmaps`. `material_override`, if any,
    replaces all materials. `check` is called now and then and may raise to stop. `tracks` is told who is there, and moves them, see
    `motion`. `kept` is what was exported before, `is_shown` says whether an object (evaluated) is to be seen, `asked` is what passes
    look up, whatever the materials, `aovs` the names of what they show of them. Raises SceneError naming the object that failed.
    """
    parts, emissions = _Parts(findings, bitmaps, material_override, kept or Kept(), asked, aovs), Emissions(findings, bitmaps)
    placed, matrices, values, identities, lights = [], [], [], [], []
    for i, instance in enumerate(depsgraph.object_instances):
        if i % POLL_EVERY == 0:
            check()
        # Instances are valid for this round of the loop only: everything is copied.
        ob, matrix = instance.object, np.array(instance.matrix_world, np.float64)
        try:
            if not is_shown(ob):
                continue
            if ob.type == "LIGHT":
                light = _placed_light(instance, matrix, findings, emissions, depsgraph)
                if light is not None:
                    lights.append(light)
                    tracks.start_light(instance, matrix, light)
            elif instance.show_self and (part := parts.of(ob)):
                own, identity = object_values(instance, part.asked, depsgraph), tracks.start(instance, matrix, part.mesh)
                for sight in sights_of(instance, part, depsgraph.view_layer_eval):
                    placed.append(sight)
                    matrices.append(matrix)
                    values.append(own)
                    identities.append(identity)
        except GlanzError:
            raise
        except Exception as error:
            raise SceneError(f"object '{ob.name}' cannot be exported: {type(error).__name__}: {error}") from error
    objects = _placed_objects(placed, matrices, values, findings)
    return tracks.moved(identities, objects), tuple(lights)


def _placed_light(instance, matrix, findings, emissions, depsgraph):
    ob = instance.object
    if not is_placed(matrix[None])[0]:
        findings.note("the transform is not finite, so it is left out", f"light '{ob.name}'", IGNORED)
        return None
    return export_light(ob, matrix, findings, emissions, lambda names: object_values(instance, names, depsgraph))


def _placed_objects(parts, matrices, values, findings):
    """The objects, None where the matrix leaves nothing to see."""
    if not parts:
        return []
    matrices = np.stack(matrices)
    finite = is_placed(matrices)
    visible = finite & has_faces(matrices)
    for part, is_finite, is_visible in zip(parts, finite, visible, strict=True):
        if not is_visible:
            if is_finite:
                findings.note("the scale leaves no surface, so it is left out", f"object '{part.name}'")
            else:
                findings.note("the transform is not finite, so it is left out", f"object '{part.name}'", IGNORED)
    return [
        Object(
            name=part.name,
            mesh=part.mesh,
            world_from_object=matrix,
            materials=part.materials,
            values=own,
            hidden_from=part.hidden_from,
            **part.more,
        )
        if is_visible
        else None
        for part, matrix, own, is_visible in zip(parts, matrices, values, visible, strict=True)
    ]


def is_placed(matrices):
    """(N,): whether matrices (N, 4, 4) are finite and within what single precision can place."""
    return (np.abs(matrices) < LARGEST).all(axis=(1, 2))


def has_faces(matrices):
    """(N,): whether the linear parts of matrices (N, 4, 4) leave an area to at least some face: rank 2 or 3."""
    with np.errstate(all="ignore"):
        x, y, z = np.moveaxis(matrices[:, :3, :3], 2, 0)
        return np.any([np.cross(a, b).any(axis=1) for a, b in ((x, y), (y, z), (z, x))], axis=0)


def has_polygons(ob):
    """Whether there is anything to render of an object (evaluated) whose data is a mesh."""
    with mesh_of(ob) as mesh:
        return len(mesh.polygons) > 0


def _exported(ob, attributes):
    with mesh_of(ob) as mesh:
        return export_mesh(mesh, ob.data.name, attributes, [group.name for group in ob.vertex_groups])


def _top(ob):
    """What an object is a part of: its parent's parent, and so on, or itself."""
    while ob.parent:
        ob = ob.parent
    return ob


def _terminator_offset(ob):
    # Cycles stores it before Blender 4.5, where it is enabled.
    return getattr(ob, "shadow_terminator_shading_offset", getattr(getattr(ob, "cycles", None), "shadow_terminator_offset", 0.0))


class _Parts:
    """Meshes and materials, exported when first met."""

    def __init__(self, findings, bitmaps, material_override, kept, asked, aovs):
        self._findings = findings
        self._override = material_override
        self._kept = kept
        self._bitmaps = bitmaps
        self._asked, self._aovs = asked, aovs
        self._parts, self._materials = {}, {}

    def of(self, ob):
        """The `_Placed` mesh of an object, or None where there is nothing to render."""
        # Text, curves and metaballs come twice: as themselves, and as an instance whose data is a mesh.
        if not isinstance(ob.data, bpy.types.Mesh):
            self._note_missing_links(ob)
            if ob.type in _NOT_RENDERED:
                self._findings.note(_NOT_RENDERED[ob.type], f"object '{ob.name}'", IGNORED)
            return None
        # Instances are temporary copies: only the original and the data tell which object it is.
        key = (ob.original.as_pointer(), ob.data.as_pointer())
        if key not in self._parts:
            self._parts[key] = self._new(ob)
        return self._parts[key]

    def _new(self, ob):
        self._note_missing_links(ob)
        if not has_polygons(ob):
            return None
        # Slots, not the mesh's own list: they know which materials are linked to the object instead.
        materials = [self._override or slot.material for slot in ob.material_slots] or [self._override]
        if all(map(self._is_volume_only, materials)):
            self._findings.note(_NOT_RENDERED["VOLUME"], f"object '{ob.name}'", IGNORED)
            return None
        self._note_ignored(ob)
        values = tuple(self._material(material) for material in materials)
        attributes = frozenset(self._asked).union(*(value.attributes for value in values))
        asked = tuple(sorted(name for source, name in attributes if source == "value"))
        more = {"asset": _top(ob).name, "group": ob.lightgroup}
        return _Placed(ob.name, self._mesh(ob, frozenset(a for a in attributes if a[0] not in _OF_OBJECTS)), values, asked, more)

    def _mesh(self, ob, attributes):
        self._note_missing(ob.data, attributes)
        # Objects whose textures ask for other things get a mesh of their own.
        return self._kept.mesh(ob, attributes, lambda: _exported(ob, attributes))

    def _note_missing(self, data, attributes):
        for source, layer in attributes:
            if source in ("uv", "tangent") and layer and layer not in data.uv_layers:
                self._findings.note(f"there is no UV map '{layer}', it counts as 0", f"mesh '{data.name}'", MISSING)

    def _note_missing_links(self, ob):
        # What is evaluated of a mesh does not know whether that was there.
        ob = ob.original
        for datablock, kind in ((ob, "object"), (ob.instance_collection, "collection"), (ob.data, ob.type.lower())):
            if datablock is not None:
                note_missing(datablock, f"{kind} '{datablock.name}'", self._findings)

    def _material(self, material):
        def make(findings):
            return export_material(material, findings, self._bitmaps, self._aovs)

        return self._once(material, "all", lambda: self._kept.looks.of(material, frozenset(self._aovs), self._findings, make))

    def _is_volume_only(self, material):
        return self._once(material, "volume", lambda: is_volume_only(material))

    def _once(self, material, what, make):
        key = what, material.as_pointer() if material else None
        if key not in self._materials:
            self._materials[key] = make()
        return self._materials[key]

    def _note_ignored(self, ob):
        name = f"object '{ob.name}'"
        if ob.is_shadow_catcher:
            self._findings.note("shadow catchers are rendered as ordinary objects", name, IGNORED)
        if _terminator_offset(ob) > 0:
            self._findings.note("the Shading Offset of its Shadow Terminator is ignored", name, IGNORED)
        for system in ob.particle_systems:
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self._findings.note("hair particles are not rendered", name, IGNORED)
