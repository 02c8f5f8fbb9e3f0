"""Who sees an object: its own flags, those of what it is an instance of, and its collection in the view layer."""

import bpy
import pytest

from glanz.engine import RAY_KINDS, Transparent
from glanz.tests.addon import blender

ALL_BUT_CAMERA = ("diffuse", "glossy", "transmission", "shadow")


def sights():
    """[(hidden_from, holdout of the material)] of the exported objects, and no warning."""
    scene, warnings = blender.export()
    assert warnings == ()
    return [(o.hidden_from, o.materials[0].holdout) for o in scene.objects]


def in_collection(ob):
    """The layer collection of a new collection that `ob` is moved into."""
    collection = bpy.data.collections.new("C")
    root = bpy.context.scene.collection
    root.children.link(collection)
    collection.objects.link(ob)
    root.objects.unlink(ob)
    return bpy.context.view_layer.layer_collection.children["C"]


def test_lights_and_worlds_are_hidden_from_kinds():
    lamp = blender.link("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    lamp.visible_diffuse = lamp.visible_transmission = False
    blender.set_world((1, 1, 1)).cycles_visibility.glossy = False
    scene, warnings = blender.export()
    assert (scene.lights[0].hidden_from, scene.world.hidden_from, warnings) == (("diffuse", "transmission"), ("glossy",), ())


NOTHING, ALL = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
HELD = [(ALL_BUT_CAMERA, ALL), (("camera",), NOTHING)]


@pytest.mark.parametrize("kind", RAY_KINDS)
def test_the_flags_of_an_object_hide_it(kind):
    setattr(blender.add_plane(), f"visible_{kind}", False)
    assert sights() == [((kind,), NOTHING)]


def test_what_nobody_sees_is_left_out():
    ob = blender.add_plane()
    for kind in RAY_KINDS:
        setattr(ob, f"visible_{kind}", False)
    assert sights() == []


def test_held_out_objects_are_two():
    """What the camera sees, and themselves for all others; where the camera would not see them they are hidden."""
    ob = blender.add_plane()
    ob.is_holdout = True
    assert sights() == HELD
    ob.visible_camera = ob.visible_glossy = False
    assert sights() == [(("camera", "glossy"), NOTHING)]


def test_collections_hold_out_and_show_indirectly():
    layer = in_collection(blender.add_plane())
    assert sights() == [((), NOTHING)]
    layer.holdout = True
    assert sights() == HELD
    layer.holdout, layer.indirect_only = False, True
    assert sights() == [(("camera",), NOTHING)]


def test_instances_go_by_what_makes_them_and_by_themselves():
    original = blender.add_plane()
    original.visible_glossy = False
    collection = bpy.data.collections.new("Inner")
    collection.objects.link(original)
    bpy.context.scene.collection.objects.unlink(original)
    empty = blender.link("Empty", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    empty.visible_diffuse = False
    assert sights() == [(("diffuse", "glossy"), NOTHING)]
    empty.is_holdout = True
    assert sights() == [(ALL_BUT_CAMERA, ALL), (("camera", "diffuse", "glossy"), NOTHING)]


def test_what_passes_straight_on_is_not_held_out():
    ob = blender.add_plane()
    ob.is_holdout = True
    ob.data.materials.append(blender.new_material("Thin", "ShaderNodeBsdfPrincipled", Alpha=0.25, Emission_Strength=1.0))
    held, _ = (o.materials[0] for o in blender.export()[0].objects)
    assert held.lobes == (Transparent((0.75,) * 3),)
    assert held.holdout == pytest.approx((0.25,) * 3)
    assert held.emission == (0, 0, 0)


def test_mixed_holdouts_hold_out_their_share():
    material = bpy.data.materials.new("Mixed")
    tree = blender.new_nodes(material)
    mix = blender.add_node(tree, "ShaderNodeMixShader", Fac=0.25)
    tree.links.new(tree.nodes.new("ShaderNodeHoldout").outputs[0], mix.inputs[1])
    tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    blender.add_plane().data.materials.append(material)
    assert sights() == [((), (0.75,) * 3)]
