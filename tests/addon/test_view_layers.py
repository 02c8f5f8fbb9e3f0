"""Each view layer of a render is a picture of its own: of its collections, with its overrides, samples and passes."""

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender

RED, GREEN = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def card(name, colour, x, scene=None):
    """A square that glows, in a collection of its own that is called as it is."""
    ob = blender.add_plane(name, 1.0, (x, 0, 0))
    ob.data.materials.append(blender.new_material(name, "ShaderNodeEmission", Color=(*colour, 1), Strength=1.0))
    collection = bpy.data.collections.new(name)
    collection.objects.link(ob)
    root = (scene or bpy.context.scene).collection
    root.children.link(collection)
    bpy.context.scene.collection.objects.unlink(ob)
    return ob


@pytest.fixture
def scene():
    """A red card to the left and a green one to the right, in a blue world."""
    camera = blender.add_camera(width=16, height=16)
    camera.data.type, camera.data.ortho_scale = "ORTHO", 4
    blender.set_world((0, 0, 0.5))
    card("Left", RED, -1)
    card("Right", GREEN, 1)
    bpy.context.scene.glanz.pixel_filter = "box"
    return bpy.context.scene


def layers_of(path):
    """{layer: {pass: pixels}} of the open file, rendered through F12."""
    found = {}
    for name, values in blender.read_exr(blender.render(path / "a.exr")).items():
        layer, _, key = name.partition(".")
        found.setdefault(layer, {})[key] = values
    return found


def middles(picture):
    """What is seen in the middle of the left card, of the right one, and above."""
    return [tuple(picture[y, x, :3].tolist()) for y, x in ((8, 4), (8, 11), (1, 8))]


BLUE = (0.0, 0.0, 0.5)


def new_layer(scene, name):
    layer = scene.view_layers.new(name)
    return layer, layer.layer_collection.children


def test_layers_differ_in_what_they_hold(scene, tmp_path):
    """Excluded is not there; held out is black; seen indirectly only lets the world be seen; and a layer that is off is not rendered."""
    scene.view_layers[0].name = "All"
    for name, what in (("Excluded", "exclude"), ("Held", "holdout"), ("Indirect", "indirect_only")):
        _, collections = new_layer(scene, name)
        setattr(collections["Left"], what, True)
    off, _ = new_layer(scene, "Off")
    off.use = False
    found = layers_of(tmp_path)
    assert set(found) == {"All", "Excluded", "Held", "Indirect"}
    assert middles(found["All"]["Combined"]) == [RED, GREEN, BLUE]
    assert middles(found["Excluded"]["Combined"]) == [BLUE, GREEN, BLUE]
    assert middles(found["Held"]["Combined"]) == [(0, 0, 0), GREEN, BLUE]
    assert middles(found["Indirect"]["Combined"]) == [BLUE, GREEN, BLUE]
    assert found["Held"]["Combined"][8, 4, 3] == 0
    assert found["Indirect"]["Combined"][8, 4, 3] == 1


def test_layers_have_overrides_of_their_own(scene, tmp_path):
    white = blender.new_material("White", "ShaderNodeEmission", Color=(1, 1, 1, 1), Strength=1.0)
    layer, _ = new_layer(scene, "White")
    layer.material_override = white
    expected = {"ViewLayer": [RED, GREEN, BLUE], "White": [(1, 1, 1), (1, 1, 1), BLUE]}
    if hasattr(layer, "world_override"):
        dark, _ = new_layer(scene, "Dark")
        world = scene.world
        dark.world_override, scene.world = blender.set_world((0, 0, 0)), world
        expected["Dark"] = [RED, GREEN, (0, 0, 0)]
    found = layers_of(tmp_path)
    assert {name: middles(passes["Combined"]) for name, passes in found.items()} == expected


def test_layers_have_samples_and_passes_of_their_own(scene, tmp_path):
    scene.glanz.samples = 3
    first, (second, _) = scene.view_layers[0], new_layer(scene, "Second")
    second.samples = 5
    first.use_pass_z = second.use_pass_normal = True
    first.glanz.use_pass_sample_count = second.glanz.use_pass_sample_count = True
    found = layers_of(tmp_path)
    assert set(found["ViewLayer"]) == {"Combined", "Depth", "Sample Count"}
    assert set(found["Second"]) == {"Combined", "Normal", "Sample Count"}
    assert [np.unique(found[name]["Sample Count"]).tolist() for name in ("ViewLayer", "Second")] == [[3], [5]]


def test_a_scene_of_several_renders_what_is_its_own(scene, tmp_path):
    """Another scene with the same camera and a world and a card of its own."""
    other = bpy.data.scenes.new("Other")
    other.camera = scene.camera
    other.collection.objects.link(scene.camera)
    other.render.engine, other.glanz.samples, other.glanz.pixel_filter = "GLANZ", 2, "box"
    other.render.resolution_x = other.render.resolution_y = 16
    card("Left only", GREEN, -1, other)
    other.render.image_settings.file_format = "OPEN_EXR"
    other.render.image_settings.color_depth = "32"
    other.render.filepath = str(tmp_path / "other.exr")
    bpy.ops.render.render(write_still=True, scene="Other")
    picture = blender.read_exr(tmp_path / "other.exr")[""]
    assert middles(picture) == [GREEN, (0, 0, 0), (0, 0, 0)]
    assert middles(layers_of(tmp_path)["ViewLayer"]["Combined"]) == [RED, GREEN, BLUE]


def test_layers_catch_one_that_is_exported_from_another_s_scene(scene, monkeypatch, tmp_path):
    """The mutant forgets whose override it is."""
    from glanz.addon.export import scene as export

    monkeypatch.setattr(
        export, "_evaluated", lambda datablock, depsgraph: datablock and (None if datablock.id_type == "MATERIAL" else datablock)
    )
    with pytest.raises(AssertionError):
        test_layers_have_overrides_of_their_own(scene, tmp_path)
