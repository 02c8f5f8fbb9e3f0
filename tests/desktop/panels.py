"""Every panel that is shown while Glanz is the engine is drawn, open, for every kind of object, and nothing complains.

Blender does not draw the contents of panels that are closed, so all are registered again as open ones. What goes wrong in
a panel it prints; who started this script reads that.
"""

import bpy
import harness as ui

OF_SCENE = ("TOOL", "RENDER", "OUTPUT", "VIEW_LAYER", "SCENE", "WORLD", "COLLECTION", "TEXTURE")
OF_OBJECT = ("OBJECT", "MODIFIER", "PARTICLES", "PHYSICS", "CONSTRAINT", "DATA", "BONE", "MATERIAL")
PICTURES = {("Cube", name) for name in ("RENDER", "OUTPUT", "VIEW_LAYER", "SCENE", "WORLD", "OBJECT", "DATA", "MATERIAL")} | {
    ("Camera", "DATA"),
    ("AREA", "DATA"),
}
"""What pictures are kept of: the last of each object and context."""
drawn = set()


def main():
    bpy.ops.wm.read_homefile(use_factory_startup=True, load_ui=True)
    bpy.context.scene.render.engine = "GLANZ"
    # Some panels show what it has found.
    bpy.ops.glanz.check_scene()
    for panel in (found := properties_panels()):
        if hasattr(panel, "draw"):
            panel.draw = noting(panel.__name__, panel.draw)
    register_again(found, lambda panel: True)
    yield 0.2
    editor = ui.area()
    editor.type = "PROPERTIES"
    for ob in objects():
        bpy.context.view_layer.objects.active = ob
        ui.redraw()
        for name in (*OF_OBJECT, *OF_SCENE) if ob.name == "Cube" else OF_OBJECT:
            try:
                editor.spaces.active.context = name
            except TypeError:  # not for this kind of object
                continue
            ui.redraw()
            if (ob.name, name) in PICTURES:
                ui.shot(f"{ob.name.lower()}_{name.lower()}")
        yield 0.0
    judge()


def judge():
    """What was drawn is what had to be."""
    ours = {panel.__name__ for panel in properties_panels() if "GLANZ" in getattr(panel, "COMPAT_ENGINES", ())}
    own = {name for name in ours if name.startswith("GLANZ_")}
    shared = ours - own
    print(f"measured: drawn were {len(own & drawn)} of {len(own)} panels of Glanz, {len(shared & drawn)} of {len(shared)} that it joins")
    print(f"not drawn: {sorted((own | shared) - drawn)}")
    # Drawn where the engine cannot be loaded.
    assert own - drawn == {"GLANZ_RENDER_PT_problem"}
    assert len(shared & drawn) > 100


def objects():
    """One of each kind that has panels."""
    scene = bpy.context.scene
    cube = bpy.data.objects["Cube"]
    for kind in ("SUBSURF", "PARTICLE_SYSTEM", "CLOTH", "COLLISION", "SOFT_BODY", "FLUID", "DYNAMIC_PAINT"):
        cube.modifiers.new(kind.title(), kind)
    scene.render.use_multiview = True
    yield cube
    camera = bpy.data.objects["Camera"]
    for kind in ("PERSP", "ORTHO", "PANO"):
        camera.data.type = kind
        camera.data.dof.use_dof = True
        yield camera
    for kind in ("POINT", "SPOT", "SUN", "AREA"):
        yield link(kind, bpy.data.lights.new(kind, kind))
    yield link("Curve", bpy.data.curves.new("Curve", "CURVE"))
    yield link("Text", bpy.data.curves.new("Text", "FONT"))
    yield link("Empty", None)
    yield link("Speaker", bpy.data.speakers.new("Speaker"))
    yield link("Hair", bpy.data.hair_curves.new("Hair"))
    yield link("Volume", bpy.data.volumes.new("Volume"))
    yield link("Armature", bpy.data.armatures.new("Armature"))
    cube.active_material.glanz.use_lecture = True
    cube.active_material.glanz.k_t = (0.5, 0.5, 0.5)
    for integrator in ("distributed", "whitted_phong"):
        scene.glanz.integrator = integrator
        yield cube


def link(name, data):
    ob = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(ob)
    return ob


def properties_panels():
    """The registered panels of the Properties editor."""
    found, todo = [], [bpy.types.Panel]
    while todo:
        children = todo.pop(0).__subclasses__()
        todo += children
        found += [child for child in children if getattr(child, "bl_space_type", "") == "PROPERTIES" and child.is_registered]
    return found


def register_again(panels, is_open):
    """Register `panels` again in this order, but parents before their children; `is_open(panel)` says whether one is open at first."""
    by_name = {getattr(panel, "bl_idname", panel.__name__): panel for panel in panels}

    def depth(panel):
        parent = by_name.get(getattr(panel, "bl_parent_id", ""))
        return 1 + depth(parent) if parent else 0

    ordered = sorted(panels, key=depth)
    for panel in reversed(ordered):
        bpy.utils.unregister_class(panel)
    for panel in ordered:
        panel.bl_options = set(getattr(panel, "bl_options", ())) - {"DEFAULT_CLOSED"} | (set() if is_open(panel) else {"DEFAULT_CLOSED"})
        bpy.utils.register_class(panel)


def noting(name, draw):
    def drawing(self, context):
        drawn.add(name)
        draw(self, context)

    return drawing
