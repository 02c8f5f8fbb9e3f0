"""What a viewport does not export again, and what it does."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from glanz.addon.export import Kept, export_contents, kept as module
from glanz.tests.addon import blender


@pytest.fixture
def scene():
    """A cube of which there are two objects, one of them with a modifier, and a plane."""
    cube = blender.add_tetrahedron("Cube")
    blender.link("Twin", cube.data, (2, 0, 0))
    bent = blender.link("Bent", cube.data, (4, 0, 0))
    bent.modifiers.new("Array", "ARRAY")
    blender.add_plane("Plane")
    return Viewer()


class Viewer:
    """Exports as a viewport does: once for each change that Blender tells of."""

    def __init__(self):
        self.kept, self.meshes = Kept(), {}
        bpy.context.view_layer.update()
        self.look(bpy.context.evaluated_depsgraph_get())

    def look(self, depsgraph):
        self.kept.forget(depsgraph)
        self.kept.tidy()
        scene, self.warnings = export_contents(depsgraph, self.kept)
        self.meshes = {o.name: o.mesh for o in scene.objects}
        self.objects = {o.name: o for o in scene.objects}

    def after(self, change):
        """The meshes that are others after a change."""
        before = self.meshes
        with blender.heard_by(lambda scene, depsgraph: self.look(depsgraph)):
            change()
        return {name for name, mesh in self.meshes.items() if before.get(name) is not mesh}


def test_objects_of_one_mesh_share_it(scene):
    assert scene.meshes["Cube"] is scene.meshes["Twin"]
    assert scene.meshes["Bent"].triangles.shape[1] == 2 * scene.meshes["Cube"].triangles.shape[1]


def test_what_only_moves_keeps_its_mesh(scene):
    assert scene.after(lambda: setattr(bpy.data.objects["Cube"], "location", (0, 0, 3))) == set()
    assert scene.objects["Cube"].world_from_object[2, 3] == 3


def test_a_mesh_that_changes_is_exported_again_for_all_its_objects_alone(scene):
    def change():
        mesh = bpy.data.meshes["Tetrahedron" if "Tetrahedron" in bpy.data.meshes else "Cube"]
        mesh.vertices[0].co.x = -5
        mesh.update()
        mesh.update_tag()

    assert scene.after(change) == {"Cube", "Twin", "Bent"}
    assert scene.meshes["Cube"].vertices.min() == scene.meshes["Bent"].vertices.min() == -5


def test_a_modifier_that_changes_concerns_no_other_mesh(scene):
    """Blender may tell of those that share its mesh."""
    changed = scene.after(lambda: setattr(bpy.data.objects["Bent"].modifiers[0], "count", 3))
    assert "Bent" in changed
    assert "Plane" not in changed
    assert scene.meshes["Bent"].triangles.shape[1] == 3 * scene.meshes["Cube"].triangles.shape[1]


def test_what_comes_and_goes_leaves_the_others_as_they_are(scene):
    assert scene.after(lambda: blender.add_plane("New")) == {"New"}
    assert scene.after(lambda: bpy.data.objects.remove(bpy.data.objects["Plane"])) == set()
    assert set(scene.meshes) == {"Cube", "Twin", "Bent", "New"}


def test_without_a_look_at_owners_another_mesh_at_the_same_address_would_be_taken_for_the_old_one(scene, monkeypatch):
    """The mutant knows meshes by their address alone."""

    def thing(uid):
        data = SimpleNamespace(original=None, session_uid=uid + 1, as_pointer=lambda: 42)
        return SimpleNamespace(original=None, session_uid=uid, data=data)

    def taken():
        kept = Kept()
        first = kept.mesh(thing(2), (), lambda: "first")
        kept.begin(1)
        return first, kept.mesh(thing(7), (), lambda: "second")

    assert taken() == ("first", "second")
    monkeypatch.setattr(module, "identities", lambda *datablocks: {1})
    assert taken() == ("first", "first")


def test_images_are_read_once_and_again_after_a_change(scene):
    image = bpy.data.images.new("Image", 2, 2)
    material = blender.new_material("Shown", "ShaderNodeEmission")
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    material.node_tree.links.new(texture.outputs[0], material.node_tree.nodes["Emission"].inputs["Color"])
    scene.after(lambda: bpy.data.meshes["Plane"].materials.append(material))

    def bitmap():
        return scene.objects["Plane"].materials[0].emission.bitmap

    first = bitmap()
    scene.after(lambda: setattr(bpy.data.objects["Cube"], "location", (0, 0, 3)))
    assert bitmap() is first

    def paint():
        image.pixels.foreach_set(np.ones(16, np.float32))
        image.update()
        image.update_tag()

    scene.after(paint)
    assert bitmap() is not first


def test_materials_are_read_once_and_again_after_a_change(scene):
    material = blender.new_material("Lamp", "ShaderNodeEmission")
    scene.after(lambda: bpy.data.meshes["Plane"].materials.append(material))

    def look():
        return scene.objects["Plane"].materials[0]

    first = look()
    scene.after(lambda: setattr(bpy.data.objects["Cube"], "location", (0, 0, 3)))
    assert look() is first
    scene.after(lambda: setattr(material.node_tree.nodes["Emission"].inputs["Strength"], "default_value", 7))
    assert look().emission == (7, 7, 7)


def test_what_is_missing_is_told_each_time(scene):
    material = blender.new_material("Shown", "ShaderNodeEmission")
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    material.node_tree.links.new(texture.outputs[0], material.node_tree.nodes["Emission"].inputs["Color"])
    texture.image = bpy.data.images.new("Gone", 2, 2)
    texture.image.source, texture.image.filepath = "FILE", "//nowhere.png"
    scene.after(lambda: bpy.data.meshes["Plane"].materials.append(material))
    told = scene.warnings
    assert any("Gone" in line for line in told)
    scene.after(lambda: setattr(bpy.data.objects["Cube"], "location", (0, 0, 3)))
    assert scene.warnings == told


def test_hidden_objects_are_left_out(scene):
    contents, _ = export_contents(bpy.context.evaluated_depsgraph_get(), Kept(), lambda ob: ob.name != "Twin")
    assert {o.name for o in contents.objects} == {"Cube", "Bent", "Plane"}


def test_a_mesh_that_is_edited_is_exported_as_it_is(scene):
    bpy.context.view_layer.objects.active = bpy.data.objects["Plane"]
    triangles = scene.meshes["Plane"].triangles.shape[1]
    try:
        scene.after(lambda: bpy.ops.object.mode_set(mode="EDIT"))
        assert scene.meshes["Plane"].triangles.shape[1] == triangles

        def subdivide():
            bpy.ops.mesh.select_all(action="SELECT")
            bpy.ops.mesh.subdivide()

        scene.after(subdivide)
        assert scene.meshes["Plane"].triangles.shape[1] == 4 * triangles
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


def test_objects_that_share_a_mesh_which_is_edited_are_there():
    """In a render and in 3D views; only one of them is in Edit Mode."""
    blender.add_camera()
    plane = blender.add_plane("One")
    blender.add_plane("Two", mesh=plane.data)
    bpy.context.view_layer.objects.active = plane
    try:
        bpy.ops.object.mode_set(mode="EDIT")
        contents, _ = export_contents(bpy.context.evaluated_depsgraph_get(), Kept())
        for scene in (contents, blender.export()[0]):
            assert [(o.name, o.mesh.triangles.shape[1]) for o in scene.objects] == [("One", 2), ("Two", 2)]
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


def test_pictures_that_are_not_asked_for_any_more_are_forgotten():
    """As those of frames that are gone, of a sequence or a movie."""
    blender.add_camera()
    material = bpy.data.materials.new("Poster")
    tree = blender.new_nodes(material)
    texture, shader = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeBsdfDiffuse")
    tree.links.new(texture.outputs[0], shader.inputs["Color"])
    tree.links.new(shader.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    blender.add_plane().data.materials.append(material)
    viewer = Viewer()
    for i in range(4):
        viewer.after(lambda i=i: setattr(texture, "image", bpy.data.images.new(f"Frame {i}", 4, 4)))
        assert viewer.objects["Plane"].materials[0].lobes[0].reflectance.bitmap.name == f"Frame {i}"
    assert len(viewer.kept._bitmaps._known) <= 2
