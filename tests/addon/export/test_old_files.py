"""Old files and those of others: what is not there any more leaves a picture, and a warning that names it; nothing in them is run."""

import bpy
import pytest

from glanz.addon.capture import Findings, capture, open_blend
from glanz.addon.export.findings import MISSING
from glanz.tests.addon import blender


def saved(path):
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def opened(path):
    """({what: {owner}}, engine scene) of a file."""
    open_blend(path)
    findings = Findings()
    scene = capture(findings=findings)[0]
    owners = {}
    for note in findings.notes:
        owners.setdefault(note.what, {})[note.owner] = note
    return owners, scene


def datablocks_of_a_library():
    """One of each kind, {name of the collection in `bpy.data`: data-block}."""
    collection = bpy.data.collections.new("Set")
    ob = blender.add_tetrahedron("Prop")
    collection.objects.link(ob)
    light = bpy.data.lights.new("Bulb", "POINT")
    group = bpy.data.node_groups.new("Aged", "ShaderNodeTree")
    group.interface.new_socket("Colour", in_out="OUTPUT", socket_type="NodeSocketColor")
    material = blender.new_material("Oak", "ShaderNodeBsdfDiffuse")
    found = {"collections": collection, "objects": ob, "lights": light, "node_groups": group, "materials": material}
    return found | {
        "worlds": bpy.data.worlds.new("Dusk"),
        "meshes": blender.new_mesh("Leaf", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]),
    }


def test_everything_that_is_missing_from_a_library_is_named(tmp_path):
    library = tmp_path / "library.blend"
    names = {kind: datablock.name for kind, datablock in datablocks_of_a_library().items()}
    bpy.data.libraries.write(str(library), {getattr(bpy.data, kind)[name] for kind, name in names.items()}, fake_user=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        for kind, name in names.items():
            setattr(wanted, kind, [name])
    linked = {kind: getattr(bpy.data, kind)[name] for kind, name in names.items()}
    blender.add_camera()
    scene = bpy.context.scene
    scene.world = linked["worlds"]
    scene.collection.objects.link(linked["objects"])
    scene.collection.children.link(linked["collections"])
    blender.link("Empty", None).instance_type = "COLLECTION"
    bpy.data.objects["Empty"].instance_collection = linked["collections"]
    blender.link("Tree", linked["meshes"])
    blender.link("Lamp", linked["lights"])
    blender.add_plane("Table").data.materials.append(linked["materials"])
    own = blender.new_material("Own", "ShaderNodeBsdfDiffuse")
    user = own.node_tree.nodes.new("ShaderNodeGroup")
    user.node_tree = linked["node_groups"]
    own.node_tree.links.new(user.outputs[0], own.node_tree.nodes["Diffuse BSDF"].inputs["Color"])
    blender.add_plane("Chair").data.materials.append(own)
    main = saved(tmp_path / "main.blend")
    whole, _ = opened(main)
    assert not whole
    library.unlink()
    notes, scene = opened(main)
    (what,) = (what for what in notes if "library" in what)
    assert "library.blend" in what
    expected = {"collection 'Set'", "object 'Prop'", "light 'Lamp'", "material 'Oak'", "world 'Dusk'", "mesh 'Leaf'"}
    assert set(notes[what]) == expected
    assert notes["the node group is missing"]["material 'Own'"].node == ("Group",)
    assert {note.kind for owners in (notes[what], notes["the node group is missing"]) for note in owners.values()} == {MISSING}
    assert {o.name for o in scene.objects} == {"Table", "Chair"}


def test_nodes_and_the_engine_of_an_add_on_that_is_gone(tmp_path):
    class GoneNode(bpy.types.ShaderNode):
        bl_idname, bl_label = "GlanzTestGone", "Gone"

        def init(self, context):
            self.outputs.new("NodeSocketShader", "Shader")
            self.outputs.new("NodeSocketColor", "Color")

    class GoneEngine(bpy.types.RenderEngine):
        bl_idname, bl_label = "GLANZ_TEST_GONE", "Gone"

    for cls in (GoneNode, GoneEngine):
        bpy.utils.register_class(cls)
    try:
        for name in ("Surface", "Color"):
            material = blender.new_material(name, "ShaderNodeEmission")
            tree = material.node_tree
            gone = tree.nodes.new("GlanzTestGone")
            target = tree.nodes["Material Output"].inputs["Surface"] if name == "Surface" else tree.nodes["Emission"].inputs["Color"]
            tree.links.new(gone.outputs["Shader" if name == "Surface" else "Color"], target)
            blender.add_plane(name).data.materials.append(material)
        blender.add_camera()
        bpy.context.scene.render.engine = "GLANZ_TEST_GONE"
        path = saved(tmp_path / "main.blend")
    finally:
        for cls in (GoneNode, GoneEngine):
            bpy.utils.unregister_class(cls)
    notes, scene = opened(path)
    assert notes["Undefined is not supported and is rendered black"]["material 'Surface'"].node == ("Gone",)
    assert any("linked to Undefined, which is not read" in what and "material 'Color'" in owners for what, owners in notes.items())
    assert {o.name for o in scene.objects} == {"Surface", "Color"}


def test_what_is_empty_is_rendered_as_blender_does_without_a_word(tmp_path):
    blender.add_plane("Empty slot").data.materials.append(None)
    blender.add_plane("No slot")
    blender.link("Nothing", None)
    blender.link("Bare", bpy.data.meshes.new("Bare"))
    blender.add_camera()
    notes, scene = opened(saved(tmp_path / "main.blend"))
    assert not notes
    slot, none = scene.objects
    assert (slot.name, none.name) == ("Empty slot", "No slot")
    assert slot.materials == none.materials


@pytest.mark.parametrize("kind", ["driver", "text"])
def test_nothing_in_a_file_is_run_and_that_is_said(kind, tmp_path):
    plane, ran = blender.add_plane(), tmp_path / "ran"
    blender.add_camera()
    code = f"__import__('pathlib').Path({str(ran)!r}).touch()"
    if kind == "text":
        text = bpy.data.texts.new("run.py")
        text.write(code)
        text.use_module = True
    else:
        plane.driver_add("location", 0).driver.expression = f"{code} or 1.0"
    path = saved(tmp_path / "main.blend")
    ran.unlink(missing_ok=True)
    before = bpy.context.preferences.filepaths.use_scripts_auto_execute
    notes, scene = opened(path)
    assert not ran.exists()
    assert any("scripts of the file are not run" in what for what in notes)
    assert len(scene.objects) == 1
    assert bpy.context.preferences.filepaths.use_scripts_auto_execute == before
