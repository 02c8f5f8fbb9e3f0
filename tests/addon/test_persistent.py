"""Persistent data: frames that only differ in their camera are compiled once, and nothing that changes is overlooked."""

from dataclasses import replace

import bpy
import numpy as np
import pytest

from glanz.addon import persistent
from glanz.addon.persistent import is_same
from glanz.engine import plan as plans
from glanz.engine.world import compile
from glanz.engine.world.accel import Accel
from glanz.tests.addon import blender
from glanz.tests.addon.export.test_images import sequence


@pytest.fixture
def compiled(monkeypatch):
    """A scene of persistent data; the list of what was compiled."""
    done = []
    compile_world = plans.compile_world
    monkeypatch.setattr(plans, "compile_world", lambda *args, **kwargs: done.append(args) or compile_world(*args, **kwargs))
    blender.add_camera(width=16, height=16)
    blender.set_world((1, 0.8, 0.6))
    bpy.context.scene.render.use_persistent_data = True
    return done


def _frames(folder, count=2):
    """The pictures of an animation."""
    return [passes["ViewLayer.Combined"] for passes in _all_passes(folder, count)]


def _all_passes(folder, count=2):
    """The passes of each frame of an animation."""
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, count
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format, image.color_depth = "OPEN_EXR_MULTILAYER", "32"
    scene.render.filepath = f"{folder}/####.exr"
    bpy.ops.render.render(animation=True)
    # The eyes of a stereo camera have a file each.
    files = [sorted(folder.glob(f"{frame:04}*.exr")) for frame in range(1, count + 1)]
    return [{path.stem[4:] + name: values for path in eyes for name, values in blender.read_exr(path).items()} for eyes in files]


def _animate(owner, path, first, second):
    for frame, value in ((1, first), (2, second)):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def _shape(plane):
    plane.shape_key_add(name="Basis")
    key = plane.shape_key_add(name="Large")
    for point in key.data:
        point.co *= 3
    _animate(key, "value", 0.0, 1.0)


def _material(plane):
    material = blender.new_material("Red", "ShaderNodeBsdfDiffuse", Color=(0.8, 0.1, 0.1, 1))
    plane.data.materials.append(material)
    colour = material.node_tree.nodes[0].inputs[0]
    _animate(colour, "default_value", (0.8, 0.1, 0.1, 1), (0.1, 0.1, 0.8, 1))


def _world(plane):
    _animate(bpy.context.scene.world.node_tree.nodes[0].inputs["Strength"], "default_value", 1.0, 2.0)


def _close_up(plane):
    """A millimetre of the plane, a kilometre from where the camera was: single precision asks for a render space of its own."""
    plane.scale *= 2000
    camera = bpy.context.scene.camera
    camera.data.clip_start = 1e-4
    _animate(camera, "location", (0, 0, 5), (1000, 0, 1e-3))


def _setting(name, first, second):
    scene = bpy.context.scene
    for frame, value in ((1, first), (2, second)):
        setattr(scene.glanz, name, value)
        scene.keyframe_insert(f"glanz.{name}", frame=frame)


FREE = {
    "nothing": lambda plane: None,
    "the camera": lambda plane: _animate(bpy.context.scene.camera, "location", (0, 0, 5), (1, 0, 5)),
    "the seed": lambda plane: _setting("seed", 0, 5),
}
"""Changes that need no new plan."""
OF_LOOKS = {
    "a material": _material,
    "the world": _world,
    "the bounces": lambda plane: _setting("max_depth", 0, 3),
    "the precision": lambda plane: _setting("precision", "fast", "exact"),
}
"""Changes that leave Embree's tree as it is."""
OF_SHAPES = {
    "the camera, by far": _close_up,
    "a place": lambda plane: _animate(plane, "location", (0, 0, 0), (0.5, 0, 0)),
    "a shape": _shape,
    "what is rendered": lambda plane: _animate(plane, "hide_render", False, True),
}
CHANGES = FREE | OF_LOOKS | OF_SHAPES


@pytest.fixture
def trees(monkeypatch):
    """The list of what Embree made trees of."""
    done = []
    monkeypatch.setattr(compile, "Accel", lambda *args: done.append(args) or Accel(*args))
    return done


@pytest.mark.parametrize("change", CHANGES)
def test_frames_are_those_without_persistent_data(change, compiled, trees, tmp_path):
    """To the bit, but for a camera that moves: there positions are rounded otherwise."""
    plane = blender.add_plane()
    blender.add_tetrahedron()
    CHANGES[change](plane)
    kept = _frames(tmp_path)
    assert len(compiled) == (1 if change in FREE else 2)
    assert len(trees) == (2 if change in OF_SHAPES else 1)
    bpy.context.scene.render.use_persistent_data = False
    fresh = _frames(tmp_path)
    assert len(compiled) == (3 if change in FREE else 4)
    if change == "the camera":
        assert (np.abs(kept[1] - fresh[1]) < 1e-3).mean() > 0.98
    else:
        np.testing.assert_array_equal(kept, fresh)
    assert (kept[0] != kept[1]).any() == (change != "nothing")


def _moving_picture(plane, folder):
    image = sequence(folder, (1, 2, 3))
    image.name = "Sequence"
    material = blender.new_material("Poster", "ShaderNodeEmission")
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image, node.image_user.frame_duration = image, 3
    material.node_tree.links.new(node.outputs[0], material.node_tree.nodes["Emission"].inputs["Color"])
    plane.data.materials.append(material)


def _layers():
    """One that has all, one without what is in a collection, whose materials are all the same, and a world that is another."""
    scene = bpy.context.scene
    other = scene.view_layers.new("Other")
    other.material_override = blender.new_material("Lamp", "ShaderNodeEmission", Color=(0, 3, 0, 1), Strength=1)
    collection = bpy.data.collections.new("Collection")
    scene.collection.children.link(collection)
    collection.objects.link(bpy.data.objects.new("Hidden", bpy.data.meshes["Tetrahedron"]))
    other.layer_collection.children["Collection"].exclude = True


def _eyes():
    render = bpy.context.scene.render
    render.use_multiview, render.image_settings.views_format = True, "INDIVIDUAL"


def _blur():
    render = bpy.context.scene.render
    render.use_motion_blur, render.motion_blur_shutter = True, 1.5


def test_layers_eyes_and_blur_are_those_without_persistent_data(compiled, tmp_path):
    """Frames of what moves, bends, comes and goes, of a sequence, and of instances, in all passes, to the bit."""
    plane, bent = blender.add_plane("Poster", size=3), blender.add_plane("Bent", size=2)
    _shape(bent)
    _moving_picture(plane, tmp_path)
    moved = blender.add_tetrahedron()
    _animate(moved, "location", (0, 0, 0), (0.5, 0, 0.2))
    instancer = blender.add_plane("Instancer", size=4)
    instancer.instance_type = "VERTS"
    instance = blender.add_tetrahedron("Instance")
    instance.parent = instancer
    _animate(instance, "scale", (1, 1, 1), (0.5, 0.5, 0.5))
    _animate(blender.add_plane("Gone", location=(0, 0, 1)), "hide_render", True, False)
    _layers(), _eyes(), _blur()
    bpy.context.scene.glanz.samples = 1
    kept = _all_passes(tmp_path)
    bpy.context.scene.render.use_persistent_data = False
    fresh = _all_passes(tmp_path)
    assert len(kept[0]) == 4, kept[0].keys()
    for one, other in zip(kept, fresh, strict=True):
        assert one.keys() == other.keys()
        for name in one:
            np.testing.assert_array_equal(one[name], other[name], name)
    assert (kept[0]["_LViewLayer.Combined"] != kept[1]["_LViewLayer.Combined"]).any()


def test_a_change_that_is_overlooked_would_be_seen_here(compiled, tmp_path, monkeypatch):
    """The mutant takes everything for the same."""
    monkeypatch.setattr(persistent, "is_same", lambda a, b: True)
    blender.add_plane()
    _world(None)
    first, second = _frames(tmp_path)
    np.testing.assert_array_equal(first, second)


def test_what_was_edited_since_the_last_picture_is_seen(compiled, tmp_path):
    plane = blender.add_plane(size=20)
    material = blender.new_material("Lamp", "ShaderNodeEmission", Color=(1, 0, 0, 1), Strength=1)
    plane.data.materials.append(material)
    pictures = []
    for colour in ((1, 0, 0, 1), (1, 0, 0, 1), (0, 1, 0, 1)):
        material.node_tree.nodes[0].inputs["Color"].default_value = colour
        pictures.append(blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"][8, 8, :3])
    np.testing.assert_allclose(pictures, [[1, 0, 0], [1, 0, 0], [0, 1, 0]], rtol=1e-5)


def test_view_layers_are_kept_apart(compiled, tmp_path):
    blender.add_plane(size=20)
    other = bpy.context.scene.view_layers.new("Other")
    other.material_override = blender.new_material("Lamp", "ShaderNodeEmission", Color=(0, 3, 0, 1), Strength=1)
    _frames(tmp_path)
    assert len(compiled) == 2
    picture = blender.read_exr(tmp_path / "0002.exr")
    assert picture["Other.Combined"][8, 8, 1] == pytest.approx(3)
    assert picture["ViewLayer.Combined"][8, 8, 1] < 1


def test_values_are_compared_to_the_last_bit():
    blender.add_plane().data.materials.append(blender.new_material("Red", "ShaderNodeBsdfDiffuse", Color=(0.8, 0.1, 0.1, 1)))
    blender.set_world((1, 1, 1))
    (one, _), (other, _) = blender.export(), blender.export()
    assert one is not other
    assert is_same(one, other)
    o = other.objects[0]
    vertices = o.mesh.vertices.copy()
    vertices[2, 3] = np.nextafter(vertices[2, 3], np.float32(1))
    assert not is_same(one, replace(other, objects=(replace(o, mesh=replace(o.mesh, vertices=vertices)),)))
    assert not is_same(one, replace(other, objects=(replace(o, name="B"),)))
    assert not is_same(one, replace(other, objects=()))
    assert not is_same({"a": 1}, {"b": 1})
    assert not is_same(1, 1.0)
    # What it does not know is the same only if it is one thing.
    assert not is_same(object(), object())
    assert is_same(persistent, persistent)


def test_what_is_left_out_is_told_for_each_frame(compiled, tmp_path):
    blender.link("Far", blender.new_mesh("Far", [(0, 0, 0), (1e30, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    _frames(tmp_path)
    assert len(compiled) == 1
    told = [value for name, value in blender.header(tmp_path / "0002.exr").items() if name.endswith("warnings")]
    assert told == ["1"]
