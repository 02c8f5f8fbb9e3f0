"""What a render or Check Scene has found out about scenes, kept in memory: what they ask for, what is not as in Blender."""

import json
from dataclasses import dataclass

import bpy
from bpy.props import StringProperty

from . import backend
from .reports import counted, describe

_RENDERED = ("MESH", "CURVE", "SURFACE", "FONT", "META", "CURVES", "POINTCLOUD", "VOLUME", "LIGHT", "GPENCIL", "GREASEPENCIL")
_checks = {}


@dataclass(frozen=True)
class Check:
    """What was found out.

    features  {what the scene asks for, in words: names of who does}
    notes     `Note`s of the export, and of the engine
    origin    what has found it out, and when, for people
    """

    features: dict
    notes: tuple
    origin: str


def keep(scene, layer_name, check):
    """Remember a `Check` of a view layer of a scene (original), in place of the one before."""
    known = {_key(scene, layer.name) for scene in bpy.data.scenes for layer in scene.view_layers}
    for key in [key for key in _checks if key not in known]:
        del _checks[key]
    _checks[_key(scene, layer_name)] = check


def check_of(scene, layer_name):
    """The last `Check` of a view layer of a scene, or None."""
    return _checks.get(_key(scene, layer_name))


def _key(scene, layer_name):
    return getattr(scene, "session_uid", 0) or scene.as_pointer(), layer_name


class GLANZ_OT_check_scene(bpy.types.Operator):
    """Look at the scene as 3D views have it, without a render: what it asks for, and what will not be as in Blender"""

    bl_idname = "glanz.check_scene"
    bl_label = "Check Scene"

    @classmethod
    def poll(cls, context):
        return context.scene.render.engine == "GLANZ" and not backend.problem()

    def execute(self, context):
        from ..engine import GlanzError, Requirements, validate
        from .export import Findings, export_still
        from .settings import settings_of

        scene, layer, findings = context.scene, context.view_layer, Findings()
        try:
            depsgraph = context.evaluated_depsgraph_get()
            settings = settings_of(depsgraph.scene_eval, depsgraph.view_layer_eval)
            exported = export_still(depsgraph, settings, findings)
            _, warnings = validate(exported, settings)
            features = Requirements.of(exported, settings).in_words()
        except GlanzError as error:
            self.report({"ERROR"}, describe(error))
            return {"CANCELLED"}
        findings.take(warnings)
        for ob in layer.objects:
            if ob.type in _RENDERED and not ob.hide_render and not ob.visible_get(view_layer=layer):
                findings.note("it is hidden in 3D views, so it was not checked", f"object '{ob.name}'")
        keep(scene, layer.name, Check(features, findings.notes, f"Checked at frame {scene.frame_current}"))
        self.report({"INFO"}, f"{counted(len(findings.lines()), 'warning')}, see Scene Requirements")
        return {"FINISHED"}


class GLANZ_OT_show(bpy.types.Operator):
    """Select the objects that are concerned, with their material, and the node"""

    bl_idname = "glanz.show"
    bl_label = "Show"
    bl_options = frozenset({"UNDO"})

    datablock: StringProperty(options={"HIDDEN"})
    name: StringProperty(options={"HIDDEN"})
    node: StringProperty(options={"HIDDEN"}, default="[]")

    def execute(self, context):
        concerned = _concerned(context, self.datablock, self.name)
        if concerned:
            for ob in context.view_layer.objects:
                ob.select_set(ob in concerned)
            context.view_layer.objects.active = concerned[0]
        if self.datablock == "material":
            for ob in concerned:
                ob.active_material_index = next(i for i, slot in enumerate(ob.material_slots) if _is_named(slot.material, self.name))
        found = _select_node(_tree(context, self.datablock, self.name), json.loads(self.node))
        if found:
            self._turn_editors(context)
        if not (concerned or found):
            self.report({"WARNING"}, f"{self.datablock} '{self.name}' is not in this view layer")
            return {"CANCELLED"}
        return {"FINISHED"}

    def _turn_editors(self, context):
        """Let the node editors that follow the selection show where the node is."""
        for area in context.screen.areas if context.screen else ():
            space = area.spaces.active
            if area.type == "NODE_EDITOR" and space.tree_type == "ShaderNodeTree" and not space.pin:
                space.shader_type = "WORLD" if self.datablock == "world" else "OBJECT"


def _is_named(datablock, name):
    return datablock is not None and datablock.name == name


def _concerned(context, kind, name):
    """The objects of the view layer that a note is about."""
    objects = context.view_layer.objects
    if kind == "material":
        return [ob for ob in objects if any(_is_named(slot.material, name) for slot in ob.material_slots)]
    if kind == "mesh":
        return [ob for ob in objects if _is_named(ob.data, name)]
    return [ob for ob in objects if kind in ("object", "light", "camera") and ob.name == name]


def _tree(context, kind, name):
    """The node tree of a material, world or light (by its object), or None."""
    if kind == "light":
        owner = next((ob.data for ob in context.view_layer.objects if ob.name == name), None)
    else:
        owner = {"material": bpy.data.materials, "world": bpy.data.worlds}.get(kind, {}).get(name)
    return owner and owner.node_tree


def _select_node(tree, names):
    """Whether there is such a node in a tree, or in the groups in it; then it is the active one."""
    node = None
    for name in names:
        node = tree and tree.nodes.get(name)
        if node is None:
            return False
        for other in tree.nodes:
            other.select = other == node
        tree.nodes.active = node
        tree = getattr(node, "node_tree", None)
    return node is not None


_CLASSES = (GLANZ_OT_check_scene, GLANZ_OT_show)


def register():
    for operator in _CLASSES:
        bpy.utils.register_class(operator)


def unregister():
    _checks.clear()
    for operator in reversed(_CLASSES):
        bpy.utils.unregister_class(operator)
