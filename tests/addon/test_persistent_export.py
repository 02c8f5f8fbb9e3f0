"""Persistent data: what is as it was is not read again, and whatever changes is, whether Blender tells of it or not."""

import os
import random
from contextlib import suppress

import bpy
import numpy as np
import pytest

from glanz.addon import export, persistent
from glanz.addon.export import Findings, Kept, bitmaps, images, kept as module, objects, scene, stamps
from glanz.addon.persistent import is_same
from glanz.tests.addon import blender
from glanz.tests.addon.export.test_images import movie, save, sequence, tiled
from glanz.tests.addon.more_changes import MoreChanges
from glanz.tests.chance import SEED


class Renders:
    """F12 with persistent data, of which each export is compared with one from scratch.

    read   the meshes and images that were read, by name, of the last F12
    looks  the same of materials and worlds
    wrong  how many exports were another
    """

    def __init__(self, monkeypatch):
        self.read, self.looks, self.wrong = [], [], 0
        self._is_fresh = False
        export_views = export.export_views

        def compared(*args):
            found = export_views(*args)
            self._is_fresh = True
            fresh = export_views(*args[:-2], Findings(), Kept())
            self._is_fresh = False
            self.wrong += not is_same(found, fresh)
            return found

        monkeypatch.setattr(export, "export_views", compared)
        self._listen(monkeypatch, objects, "_exported", "read")
        self._listen(monkeypatch, images, "_read", "read")
        self._listen(monkeypatch, bitmaps, "tiles_of", "read")
        self._listen(monkeypatch, objects, "export_material", "looks")
        self._listen(monkeypatch, scene, "export_world", "looks")

    def _listen(self, monkeypatch, module, name, heard):
        original = getattr(module, name)

        def listening(datablock, *args):
            if datablock and not self._is_fresh:
                getattr(self, heard).append(datablock.name)
            return original(datablock, *args)

        monkeypatch.setattr(module, name, listening)

    def f12(self):
        self.read, self.looks = [], []
        bpy.context.scene.render.use_persistent_data = True
        bpy.ops.render.render()
        return self.read


@pytest.fixture
def renders(monkeypatch):
    blender.add_camera(width=8, height=8)
    bpy.context.scene.glanz.samples = 1
    return Renders(monkeypatch)


def _shown(image, node_type="ShaderNodeTexImage"):
    """A node that shows an image: of a plane's material, or of the world."""
    if node_type == "ShaderNodeTexEnvironment":
        owner = blender.set_world((1, 1, 1))
        shader = owner.node_tree.nodes["Background"]
    else:
        owner = blender.new_material("Shown", "ShaderNodeEmission")
        blender.add_plane().data.materials.append(owner)
        shader = owner.node_tree.nodes["Emission"]
    node = owner.node_tree.nodes.new(node_type)
    node.image = image
    owner.node_tree.links.new(node.outputs[0], shader.inputs["Color"])
    return node


def test_what_is_as_it_was_is_not_read_again(renders):
    moved, reshaped = blender.add_plane("Moved"), blender.add_plane("Reshaped")
    blender.add_plane("Still").modifiers.new("Subdivided", "SUBSURF")
    _shown(bpy.data.images.new("Image", 4, 4))
    _shown(bpy.data.images.new("Sky", 4, 4), "ShaderNodeTexEnvironment")
    assert sorted(renders.f12()) == ["Image", "Moved", "Plane", "Reshaped", "Sky", "Still"]
    assert renders.looks == ["World", "Shown"]
    assert renders.f12() == renders.looks == []
    moved.location.x = 1
    bpy.context.scene.camera.location.x = 1
    bpy.data.materials["Shown"].node_tree.nodes["Emission"].inputs["Strength"].default_value = 2
    bpy.context.scene.frame_set(7)
    # An image is read again where Blender says no more than that the nodes have changed which show it.
    assert set(renders.f12()) <= {"Image"}
    assert renders.looks == ["Shown"]
    reshaped.data.vertices[0].co.z = 1
    assert renders.f12() == ["Reshaped"]
    assert renders.looks == []
    assert renders.wrong == 0


def _in_a_group(material):
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    group.interface.new_socket("Value", in_out="OUTPUT", socket_type="NodeSocketFloat")
    value, output = group.nodes.new("ShaderNodeValue"), group.nodes.new("NodeGroupOutput")
    group.links.new(value.outputs[0], output.inputs[0])
    node = material.node_tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    material.node_tree.links.new(node.outputs[0], material.node_tree.nodes["Emission"].inputs["Strength"])
    return lambda: setattr(value.outputs[0], "default_value", 3)


def _of_an_object(material):
    tree, empty = material.node_tree, blender.link("Empty", None)
    node = tree.nodes.new("ShaderNodeTexCoord")
    node.object = empty
    tree.links.new(node.outputs["Object"], tree.nodes["Emission"].inputs["Color"])
    return lambda: setattr(empty, "location", (1, 2, 3))


def _driven(material):
    strength = material.node_tree.nodes["Emission"].inputs["Strength"]
    strength.driver_add("default_value").driver.expression = "frame"
    return lambda: bpy.context.scene.frame_set(5)


def _of_the_lecture(material):
    material.glanz.use_lecture = True
    return lambda: setattr(material.glanz, "k_d", (0.1, 0.2, 0.3))


def _indexed(material):
    return lambda: setattr(material, "pass_index", 3)


def _named(material):
    return lambda: setattr(material, "name", "Another")


def _swapped(material):
    other = blender.new_material("Other", "ShaderNodeBsdfDiffuse")
    return lambda: bpy.data.meshes["Plane"].materials.__setitem__(0, other)


def _overridden(material):
    return lambda: setattr(bpy.context.view_layer, "material_override", blender.new_material("Other", "ShaderNodeBsdfDiffuse"))


@pytest.mark.parametrize("edit", [_in_a_group, _of_an_object, _driven, _of_the_lecture, _indexed, _named, _swapped, _overridden])
def test_materials_that_change_are_read_again(edit, renders):
    material = blender.new_material("Shown", "ShaderNodeEmission")
    blender.add_plane().data.materials.append(material)
    change = edit(material)
    renders.f12()
    change()
    renders.f12()
    assert renders.looks
    assert renders.wrong == 0


def test_materials_that_are_believed_to_be_the_same_would_be_seen_here(renders, monkeypatch):
    monkeypatch.setattr(module, "changed_looks", lambda depsgraph: set())
    material = blender.new_material("Shown", "ShaderNodeEmission")
    blender.add_plane().data.materials.append(material)
    renders.f12()
    material.node_tree.nodes["Emission"].inputs["Strength"].default_value = 2
    renders.f12()
    assert renders.wrong == 1


def _paint(image):
    image.pixels[:] = np.linspace(0.1, 0.9, len(image.pixels)).tolist()


def _save(image):
    image.filepath_raw, image.file_format = bpy.app.tempdir + "painted.png", "PNG"
    image.save()


def _repack(image):
    image.pack()
    image.pixels[0] = 0.9
    image.pack()


EDITS = {
    "painted": _paint,
    "painted and packed": lambda image: (_paint(image), image.pack()),
    "painted and saved": lambda image: (_paint(image), _save(image)),
    "another alpha": lambda image: setattr(image, "alpha_mode", "NONE"),
    "another colour space": lambda image: setattr(image.colorspace_settings, "name", "Non-Color"),
    "another colour": lambda image: setattr(image, "generated_color", (1, 0.5, 0.2, 1)),
    "another size": lambda image: setattr(image, "generated_width", 8),
    "scaled": lambda image: image.scale(3, 3),
    "painted, packed, painted": lambda image: (_paint(image), image.pack(), image.pixels.__setitem__(0, 0.5)),
    "painted and packed twice": lambda image: (_paint(image), _repack(image)),
}


@pytest.mark.parametrize("node_type", ["ShaderNodeTexImage", "ShaderNodeTexEnvironment"])
@pytest.mark.parametrize("edit", EDITS)
def test_images_that_change_are_read_again(edit, node_type, renders):
    image = bpy.data.images.new("Image", 4, 4)
    _shown(image, node_type)
    renders.f12()
    EDITS[edit](image)
    assert renders.f12() == ["Image"]
    assert renders.wrong == 0


def _bitmap(value):
    """The content of a file of one texel."""
    sizes = b"BM" + (58).to_bytes(4, "little") + bytes(4) + (54).to_bytes(4, "little") + (40).to_bytes(4, "little")
    return sizes + b"\1\0\0\0\1\0\0\0\1\0\x18\0" + bytes(24) + bytes((value, value, value, 0))


def _pack(image, value):
    content = _bitmap(value)
    image.pack(data=content, data_len=len(content))
    image.source = "FILE"
    image.reload()


def _nobody_tells(monkeypatch):
    monkeypatch.setattr(module, "changed_images", lambda depsgraph: set())


MUTANTS = {
    "Blender is believed": (EDITS["painted"], lambda mp: mp.setattr(persistent, "stamp_of", stamps.no_stamp)),
    "as long is the same": (lambda image: _pack(image, 200), lambda mp: (_nobody_tells(mp), mp.setattr(stamps, "_digest", len))),
}


@pytest.mark.parametrize("is_mutant", [False, True])
@pytest.mark.parametrize("mutant", MUTANTS)
def test_what_is_not_looked_at_would_be_overlooked(mutant, is_mutant, renders, monkeypatch):
    edit, mutate = MUTANTS[mutant]
    if is_mutant:
        mutate(monkeypatch)
    image = bpy.data.images.new("Image", 4, 4)
    _shown(image)
    _pack(image, 10)
    renders.f12()
    edit(image)
    renders.f12()
    assert renders.wrong == is_mutant


def test_files_that_change_are_read_again(renders, tmp_path):
    """Of sequences at once, of others when Blender loads them again."""
    pictures = sequence(tmp_path)
    _shown(pictures).image_user.frame_duration = 4
    renders.f12()
    for frame, read in ((1, 0), (2, 1), (2, 0), (1, 1)):
        bpy.context.scene.frame_set(frame)
        assert len(renders.f12()) == read
    save(tmp_path / "picture_0001.png", 99)
    os.utime(tmp_path / "picture_0001.png", ns=(1, 1))
    assert len(renders.f12()) == 1
    save(tmp_path / "one.png", 10)
    one = bpy.data.images.load(str(tmp_path / "one.png"))
    _shown(one)
    renders.f12()
    save(tmp_path / "one.png", 200)
    renders.f12()
    one.reload()
    assert "one.png" in renders.f12()
    assert renders.f12() == []
    assert renders.wrong == 0


@pytest.mark.parametrize("node_type", ["ShaderNodeTexImage", "ShaderNodeTexEnvironment"])
def test_movies_and_tiles_are_read_where_they_are_others(node_type, renders, tmp_path):
    _shown(movie(tmp_path), node_type).image_user.frame_duration = 4
    _shown(tiled(tmp_path))
    renders.f12()
    # A movie has a colour space once it was looked at, which is another.
    renders.f12()
    assert renders.f12() == []
    bpy.context.scene.frame_set(2)
    assert renders.f12() == ["cut.avi"]
    save(tmp_path / "skin.1002.png", 99)
    os.utime(tmp_path / "skin.1002.png", ns=(1, 1))
    (tiles,) = {image.name for image in bpy.data.images if image.source == "TILED"}
    # Where an image has come and gone Blender says that some are others, and not which.
    assert renders.f12() == ["cut.avi", tiles]
    assert renders.f12() == []
    assert renders.wrong == 0


def test_an_edited_mesh_is_as_it_is(renders):
    plane = blender.add_plane()
    bpy.context.view_layer.objects.active = plane
    renders.f12()
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        for _ in range(2):
            bpy.ops.mesh.select_all(action="SELECT")
            bpy.ops.mesh.subdivide()
            renders.f12()
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
    renders.f12()
    assert renders.wrong == 0


def test_view_layers_share_what_was_read(renders):
    blender.add_plane("Both")
    collection = bpy.data.collections.new("Collection")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(bpy.data.objects.new("One", blender.new_mesh("One", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])))
    other = bpy.context.scene.view_layers.new("Other")
    assert sorted(renders.f12()) == ["Both", "One"]
    assert renders.f12() == []
    other.material_override = bpy.data.materials.new("Override")
    other.layer_collection.children["Collection"].exclude = True
    renders.f12()
    # What is not in all layers is new to Blender each time.
    assert renders.f12() == ["One"]
    bpy.data.meshes["Both"].vertices[0].co.z = 1
    assert sorted(renders.f12()) == ["Both", "One"]
    assert renders.wrong == 0


def _change_and_render(renders, seed, count):
    """F12 after every two of some random changes, at several frames; returns the changes if any export was another."""
    made = MoreChanges(random.Random(seed))
    for n in range(0, count, 2):
        made.make(2)
        bpy.context.scene.frame_set(n % 3)
        # As where the camera is flat.
        with suppress(RuntimeError):
            renders.f12()
        if renders.wrong:
            return f"seed {seed}, after {made.log}"
    return ""


@pytest.mark.parametrize(("seed", "count"), [(3, 24)] if SEED is None else [(int(SEED) + n, 160) for n in range(8)])
def test_whatever_changes_nothing_is_overlooked(seed, count, renders):
    assert _change_and_render(renders, seed, count) == ""


def test_shapes_that_are_overlooked_would_be_seen_here(renders, monkeypatch):
    """The mutant takes meshes at the same address for the same."""
    monkeypatch.setattr(module, "changed_shapes", lambda depsgraph: set())
    assert any(_change_and_render(renders, seed, 24) for seed in range(20))
