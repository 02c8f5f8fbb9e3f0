"""What a scene asks for, and what is not as in Blender, can be seen before a render and after it, and leads to where it is."""

from types import SimpleNamespace

import bpy
import pytest

from glanz.addon import checks, requirements_panel
from glanz.addon.checks import check_of
from glanz.tests.addon import blender

TORN = "triangles with a corner that is not finite or too far away are left out"


@pytest.fixture
def scene():
    """A plane with two slots: plain, and a toon shader whose colour is a missing image in a group."""
    group = bpy.data.node_groups.new("Aged", "ShaderNodeTree")
    group.interface.new_socket("Colour", in_out="OUTPUT", socket_type="NodeSocketColor")
    image, end = group.nodes.new("ShaderNodeTexImage"), group.nodes.new("NodeGroupOutput")
    group.links.new(image.outputs[0], end.inputs[0])
    material = blender.new_material("Shirt", "ShaderNodeBsdfToon")
    user = material.node_tree.nodes.new("ShaderNodeGroup")
    user.node_tree = group
    material.node_tree.links.new(user.outputs[0], material.node_tree.nodes["Toon BSDF"].inputs["Color"])
    plane = blender.add_plane("Man")
    plane.data.materials.append(bpy.data.materials.new("Skin"))
    plane.data.materials.append(material)
    blender.add_camera()
    blender.set_world((1, 1, 1))
    return bpy.context.scene


def found():
    return check_of(bpy.context.scene, bpy.context.view_layer.name)


def whats():
    return {note.what: note for note in found().notes}


class Layout:
    """Stands for a layout: remembers texts and buttons."""

    def __init__(self):
        self.texts, self.buttons = [], []

    def label(self, text="", **options):
        self.texts.append(text)

    def prop(self, owner, name, **options):
        assert name in owner.bl_rna.properties

    def operator(self, idname, **options):
        self.buttons.append(SimpleNamespace(idname=idname))
        return self.buttons[-1]

    def column(self, **options):
        return self

    row = split = column


def drawn(name):
    """The layout of a panel; None where it is not shown."""
    cls = getattr(requirements_panel, f"GLANZ_RENDER_PT_{name}")
    context = SimpleNamespace(engine="GLANZ", scene=bpy.context.scene, view_layer=bpy.context.view_layer)
    if not cls.poll(context):
        return None
    panel = SimpleNamespace(layout=Layout())
    panel.column = panel.layout.column
    cls.draw(panel, context)
    return panel.layout


def test_before_a_check_there_is_nothing_to_be_seen_but_how_to_make_one(scene):
    assert found() is None
    assert drawn("features") is None and drawn("differences") is None
    assert [button.idname for button in drawn("requirements").buttons] == ["glanz.check_scene"]


def test_a_check_and_a_render_find_the_same(scene, tmp_path):
    assert bpy.ops.glanz.check_scene() == {"FINISHED"}
    checked = found()
    assert "frame 1: 1 missing, 1 approximated" in drawn("requirements").texts[0]
    assert any(text.startswith("Background: ") for text in checked.features)
    assert checked.features["Camera: Perspective"] == ["Camera"]
    blender.render(tmp_path / "a.exr")
    rendered = found()
    assert rendered.origin.startswith("Rendered") and checked.origin.startswith("Checked")
    assert (rendered.features, rendered.notes) == (checked.features, checked.notes)
    assert "Man" in drawn("features").texts


def test_what_the_engine_warns_of_is_kept_with_the_others(scene, tmp_path):
    far = blender.new_mesh("Far", [(0, 0, 0), (1e30, 0, 0), (0, 1e30, 0)], [(0, 1, 2)])
    blender.link("Object", far)
    bpy.ops.glanz.check_scene()
    assert TORN not in whats()
    blender.render(tmp_path / "a.exr")
    assert whats()[TORN].datablock == ("object", "Object")
    assert whats()[TORN].kind == "ignored"


def test_a_check_finds_vertices_that_are_no_numbers_and_strict_renders_refuse_them(scene, tmp_path):
    """So it does for objects that share the mesh; the button selects them."""
    mesh = blender.new_mesh("Torn", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    mesh.vertices[1].co.x = float("nan")
    for name in ("One", "Two"):
        blender.link(name, mesh)
    bpy.ops.glanz.check_scene()
    assert [note.datablock for note in found().notes if note.what == TORN] == [("object", "One"), ("object", "Two")]
    button = next(b for b in drawn("differences").buttons if b.name == "Two")
    bpy.ops.glanz.show(datablock=button.datablock, name=button.name, node=button.node)
    assert bpy.context.view_layer.objects.active.name == "Two"
    scene.glanz.strict = True
    # The rest is not as in Blender either, which is not the point.
    bpy.data.objects["Man"].hide_render = True
    with pytest.raises(RuntimeError, match=r"corner that is not finite.*'One', object 'Two'"):
        blender.render(tmp_path / "a.exr")
    assert TORN in whats()


def test_a_check_finds_what_the_engine_leaves_out_and_refuses(scene):
    blender.link("Lamp", bpy.data.lights.new("Lamp", "POINT")).data.shadow_soft_size = 0
    scene.glanz.integrator = "path_blind"
    bpy.ops.glanz.check_scene()
    (dark,) = (note for note in found().notes if note.what.endswith("stays dark"))
    assert dark.datablock == ("light", "Lamp")
    scene.camera.data.clip_start = 2 * scene.camera.data.clip_end
    with pytest.raises(RuntimeError, match="clip range"):
        bpy.ops.glanz.check_scene()


def test_a_strict_render_leaves_no_light_out(scene, tmp_path):
    blender.link("Lamp", bpy.data.lights.new("Lamp", "POINT")).data.energy = -1
    bpy.ops.glanz.check_scene()
    assert whats()["it would take light away, so it is left out"].kind == "ignored"
    scene.glanz.strict = True
    with pytest.raises(RuntimeError, match="light 'Lamp'"):
        blender.render(tmp_path / "a.exr")


def test_a_strict_render_that_fails_leaves_its_list(scene, tmp_path):
    scene.glanz.strict = True
    with pytest.raises(RuntimeError, match="strict"):
        blender.render(tmp_path / "a.exr")
    assert {note.kind for note in found().notes} == {"missing", "approximated"}


def test_a_check_knows_what_is_rendered_and_says_what_it_does_not_see(scene):
    for name in ("Unrendered", "Unseen"):
        blender.link(name, bpy.data.volumes.new(name))
    bpy.data.objects["Unrendered"].hide_render = True
    bpy.data.objects["Unseen"].hide_viewport = True
    bpy.context.view_layer.update()
    bpy.ops.glanz.check_scene()
    assert "Unrendered" not in str(found().notes)
    off = bpy.data.collections.new("Off")
    scene.collection.children.link(off)
    off.objects.link(bpy.data.objects.new("Ghost", bpy.data.volumes.new("Ghost")))
    off.hide_render = True
    bpy.context.view_layer.update()
    bpy.ops.glanz.check_scene()
    assert "Ghost" not in str(found().notes)
    assert whats()["it is hidden in 3D views, so it was not checked"].datablock == ("object", "Unseen")


def test_a_scene_that_cannot_be_rendered_is_an_error(scene):
    scene.camera = None
    with pytest.raises(RuntimeError, match="camera"):
        bpy.ops.glanz.check_scene()


def test_buttons_lead_to_the_material_and_the_node_in_its_group(scene):
    bpy.ops.glanz.check_scene()
    plane, camera = bpy.data.objects["Man"], bpy.data.objects["Camera"]
    camera.select_set(True)
    bpy.context.view_layer.objects.active = camera
    button = next(b for b in drawn("differences").buttons if "Image" in b.node)
    bpy.ops.glanz.show(datablock=button.datablock, name=button.name, node=button.node)
    assert bpy.context.view_layer.objects.active == plane
    assert [ob.name for ob in bpy.context.view_layer.objects if ob.select_get()] == ["Man"]
    assert plane.active_material.name == "Shirt"
    tree = plane.active_material.node_tree
    assert tree.nodes.active.type == "GROUP"
    assert [node.type for node in tree.nodes if node.select] == ["GROUP"]
    assert tree.nodes.active.node_tree.nodes.active.type == "TEX_IMAGE"


def test_buttons_lead_to_lights_and_worlds(scene):
    lamp = blender.link("Lamp", bpy.data.lights.new("Bulb", "POINT"))
    scene.world.node_tree.nodes.new("ShaderNodeTexImage")
    bpy.ops.glanz.show(datablock="light", name="Lamp")
    assert bpy.context.view_layer.objects.active == lamp
    assert bpy.ops.glanz.show(datablock="world", name="World", node='["Image Texture"]') == {"FINISHED"}
    assert scene.world.node_tree.nodes.active.type == "TEX_IMAGE"
    assert bpy.ops.glanz.show(datablock="object", name="Gone") == {"CANCELLED"}


def test_checks_are_of_a_view_layer_and_end_with_their_scene(scene):
    bpy.ops.glanz.check_scene()
    assert check_of(scene, scene.view_layers.new("Other").name) is None
    other = bpy.data.scenes.new("Other")
    checks.keep(other, other.view_layers[0].name, found())
    bpy.data.scenes.remove(other)
    before = len(checks._checks)
    bpy.ops.glanz.check_scene()
    assert len(checks._checks) == before - 1
