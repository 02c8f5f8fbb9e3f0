"""Texture nodes become the engine's textures; what they are looked up at arrives with the mesh."""

import bpy
import numpy as np
import pytest

from glanz.engine import CheckerTexture, Gloss, ImageTexture, Lambert, LambertTransmission
from glanz.engine.scene.graphs import with_inner
from glanz.engine.scene.points import OnPlane
from glanz.tests.addon import blender
from glanz.tests.textured import extremes

PIXELS = np.random.default_rng(1).random((4, 6, 4)).astype(np.float32)


def new_image(name="Picture", is_float=False, pixels=PIXELS, alpha=False, colour_space="sRGB"):
    image = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=alpha, float_buffer=is_float)
    if not is_float:
        image.colorspace_settings.name = colour_space
    pixels = pixels.copy()
    if not alpha:
        pixels[..., 3] = 1
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    return image


def textured(kind, output="Color", shader="ShaderNodeBsdfDiffuse", socket="Color", **inputs):
    """(material, tree, texture node) of a texture node that feeds a shader."""
    material = blender.new_material("Mat", shader)
    tree = material.node_tree
    node = blender.add_node(tree, f"ShaderNodeTex{kind}", **inputs)
    source = next(s for s in node.outputs if s.identifier == output)
    target = next(n for n in tree.nodes if n.bl_idname == shader)
    tree.links.new(source, blender.node_input(target, socket))
    return material, tree, node


def with_layers(ob, *names, active=0):
    for name in names:
        layer = ob.data.uv_layers.new(name=name)
        layer.uv.foreach_set("vector", np.random.default_rng(len(name)).random(2 * len(ob.data.loops)).astype(np.float32))
    ob.data.uv_layers[active].active_render = True
    return ob


def exported(material, ob=None):
    """(object, warnings)."""
    ob = ob or blender.add_plane()
    ob.data.materials.append(material)
    scene, warnings = blender.export()
    return scene.objects[0], warnings


def test_a_picture_on_a_leaf_tints_what_passes():
    material, _, node = textured("Image", shader="ShaderNodeBsdfTranslucent")
    node.image = new_image()
    o, warnings = exported(material, with_layers(blender.add_plane(), "UVMap"))
    (lobe,) = o.materials[0].lobes
    assert type(lobe) is LambertTransmission
    assert type(lobe.transmittance) is ImageTexture
    assert warnings == ()


def reflectance(material, ob=None):
    o, warnings = exported(material, ob)
    assert warnings == ()
    (lobe,) = o.materials[0].lobes
    assert type(lobe) is Lambert
    return lobe.reflectance


@pytest.mark.parametrize("space", ["sRGB", "Non-Color"])
def test_bytes_arrive_as_they_are_encoded(space):
    material, _, node = textured("Image")
    node.image = new_image(colour_space=space)
    texture = reflectance(material, with_layers(blender.add_plane(), "UVMap"))
    assert type(texture) is ImageTexture
    assert texture.bitmap.is_srgb == (space == "sRGB")
    assert texture.bitmap.pixels.dtype == np.uint8
    np.testing.assert_array_equal(texture.bitmap.pixels[:3], np.round(PIXELS[..., :3] * 255).transpose(2, 0, 1))
    assert (texture.extension, texture.is_smooth, texture.coordinates.attribute) == ("repeat", True, ("uv", ""))


def test_floats_arrive_linear_also_what_is_brighter_than_1():
    material, _, node = textured("Image")
    node.image = new_image(is_float=True, pixels=2 * PIXELS)
    o, warnings = exported(material)
    assert warnings == ()
    texture = o.materials[0].lobes[0].reflectance
    np.testing.assert_array_equal(texture.bitmap.pixels[:3], 2 * PIXELS[..., :3].transpose(2, 0, 1))


def test_alpha_weighs_bytes_unless_it_is_a_channel_of_its_own():
    for mode, is_weighed in (("STRAIGHT", True), ("CHANNEL_PACKED", False), ("NONE", False)):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        material, _, node = textured("Image")
        node.image = new_image(alpha=True)
        node.image.alpha_mode = mode
        pixels = reflectance(material).bitmap.pixels[:3].astype(int)
        whole = np.round(PIXELS * 255).astype(int).transpose(2, 0, 1)
        np.testing.assert_array_equal(pixels, whole[:3] * whole[3] // 255 if is_weighed else whole[:3])


@pytest.mark.parametrize("with_name", [True, False])
def test_a_missing_image_is_magenta_and_told_once(with_name):
    material, tree, node = textured("Image")
    if with_name:
        node.image = bpy.data.images.new("Lost", 4, 4)
        node.image.source = "FILE"
        node.image.filepath = "/nowhere/lost.png"
    again = tree.nodes.new("ShaderNodeTexImage")
    again.image = node.image
    mix = tree.nodes.new("ShaderNodeMixShader")
    second = tree.nodes.new("ShaderNodeBsdfDiffuse")
    tree.links.new(again.outputs["Color"], second.inputs["Color"])
    first = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE" and n != second)
    tree.links.new(first.outputs[0], mix.inputs[1])
    tree.links.new(second.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    o, warnings = exported(material)
    assert len(warnings) == 1
    assert "magenta" in warnings[0]
    assert ("'Lost'" in warnings[0]) == with_name
    (lobe,) = o.materials[0].lobes
    assert extremes(lobe.reflectance) == ((1, 0, 1), (1, 0, 1))


def test_an_image_is_loaded_once_for_all_materials():
    image = new_image()
    bitmaps = []
    for _ in range(2):
        material, _, node = textured("Image")
        node.image = image
        bitmaps.append(material)
        blender.add_plane().data.materials.append(material)
    scene, _ = blender.export()
    first, second = (o.materials[0].lobes[0].reflectance.bitmap for o in scene.objects)
    assert first is second


@pytest.mark.parametrize(
    ("attribute", "value", "expected"),
    [
        ("extension", "CLIP", {"extension": "clip"}),
        ("extension", "MIRROR", {"extension": "mirror"}),
        ("extension", "EXTEND", {"extension": "extend"}),
        ("interpolation", "Closest", {"is_smooth": False}),
        ("interpolation", "Cubic", {"is_smooth": True, "is_cubic": True}),
        ("interpolation", "Smart", {"is_smooth": True, "is_cubic": True}),
        ("projection", "SPHERE", {"projection": "sphere"}),
        ("projection", "TUBE", {"projection": "tube"}),
    ],
)
def test_modes_of_images(attribute, value, expected):
    material, _, node = textured("Image")
    node.image = new_image()
    setattr(node, attribute, value)
    texture = reflectance(material)
    assert {name: getattr(texture, name) for name in expected} == expected


def mapped(tree, node, source="Object", **values):
    """A Texture Coordinate and a Mapping node before `node`."""
    coordinates, mapping = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
    mapping.vector_type = values.pop("vector_type", "POINT")
    for name, value in values.items():
        blender.node_input(mapping, name).default_value = value
    tree.links.new(next(s for s in coordinates.outputs if s.identifier == source), mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], node.inputs["Vector"])
    return coordinates, mapping


@pytest.mark.parametrize("vector_type", ["POINT", "TEXTURE", "VECTOR"])
def test_mappings_are_affine(vector_type):
    """A point mapped as Blender's manual has it: scaled, rotated about x, y, z, moved; or the other way round."""
    from mathutils import Euler, Vector

    location, rotation, scale = (0.3, -0.2, 0.5), (0.4, 0.2, -0.7), (2.0, 3.0, 0.5)
    material, tree, node = textured("Checker", Scale=2)
    mapped(tree, node, vector_type=vector_type, Location=location, Rotation=rotation, Scale=scale)
    texture = reflectance(material)
    coordinates = texture.coordinates
    assert coordinates.attribute == ("object", "")
    assert texture.scale == 2
    p = Vector((0.7, -1.1, 0.9))
    if vector_type == "TEXTURE":
        q = Vector(a / s for a, s in zip(Euler(rotation).to_matrix().inverted() @ (p - Vector(location)), scale))
    else:
        q = Euler(rotation).to_matrix() @ Vector(a * s for a, s in zip(p, scale))
        q += Vector(location) if vector_type == "POINT" else Vector()
    np.testing.assert_allclose(np.array(coordinates.matrix) @ (*p, 1), (*q, 1), atol=1e-5)


def test_two_mappings_follow_each_other():
    material, tree, node = textured("Checker", Scale=1)
    _, near = mapped(tree, node, Location=(1, 0, 0))
    far = tree.nodes.new("ShaderNodeMapping")
    blender.node_input(far, "Scale").default_value = (2, 2, 2)
    tree.links.new(near.inputs["Vector"].links[0].from_socket, far.inputs["Vector"])
    tree.links.new(far.outputs[0], near.inputs["Vector"])
    matrix = reflectance(material).coordinates.matrix
    assert tuple(np.array(matrix) @ (1, 1, 1, 1)) == pytest.approx((3, 2, 2, 1))


def test_coordinates_may_be_those_of_the_camera():
    material, tree, node = textured("Checker")
    mapped(tree, node, source="Camera")
    o, warnings = exported(material)
    assert warnings == ()
    assert o.materials[0].lobes[0].reflectance.coordinates.source == "camera"


def test_layers_of_coordinates_come_as_they_are_asked_for():
    """The layer for rendering first; a named one by its name; none where nothing asks; a missing one is told."""
    material, tree, node = textured("Image")
    node.image = new_image()
    uv_map = tree.nodes.new("ShaderNodeUVMap")
    ob = with_layers(blender.add_plane(), "one", "three", "fourth", active=1)
    o, _ = exported(material, ob)
    assert o.mesh.uv_layers == ("three",)
    expected = np.array([layer.vector for layer in ob.data.uv_layers["three"].uv]).T
    np.testing.assert_array_equal(o.mesh.uvs[0], expected)
    loops = np.array([t.loops for t in ob.data.loop_triangles]).T
    np.testing.assert_array_equal(o.mesh.uv_indices, loops)
    tree.links.new(uv_map.outputs[0], node.inputs["Vector"])
    for name, layers in (("one", ("one",)), ("", ("three",)), ("five", ())):
        uv_map.uv_map = name
        scene, warnings = blender.export()
        assert scene.objects[0].mesh.uv_layers == layers
        assert bool(warnings) == (name == "five")
    ob.data.materials.clear()
    assert blender.export()[0].objects[0].mesh.uv_layers == ()


def test_the_base_colour_of_principled_may_be_a_texture():
    """Diffuse and glossy share the texture, and together reflect at most 1."""
    material, _, _ = textured("Checker", shader="ShaderNodeBsdfPrincipled", socket="Base Color")
    principled = next(n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    blender.node_input(principled, "Metallic").default_value = 0.25
    o, warnings = exported(material)
    assert warnings == ()
    lobes = o.materials[0].lobes
    assert {type(lobe) for lobe in lobes} == {Lambert, Gloss}
    checkers = [{id(t) for t in with_inner(lobe.reflectance) if type(t) is CheckerTexture} for lobe in lobes]
    assert len(set.union(*checkers)) == 1
    at = OnPlane(np.random.default_rng(1).random((3, 1000), np.float32))
    assert sum(at.value(lobe.reflectance) for lobe in lobes).max() <= 1 + 1e-5


def test_emission_may_be_a_texture_and_is_scaled_by_its_strength():
    material, tree, _ = textured("Checker", "Fac", shader="ShaderNodeEmission")
    blender.node_input(next(n for n in tree.nodes if n.type == "EMISSION"), "Strength").default_value = 5
    o, warnings = exported(material)
    assert warnings == ()
    assert extremes(o.materials[0].emission) == ((0, 0, 0), (5, 5, 5))


def test_a_mix_scales_textures():
    material, tree, _ = textured("Checker", "Fac")
    mix = blender.add_node(tree, "ShaderNodeMixShader", Fac=0.25)
    tree.links.new(next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE").outputs[0], mix.inputs[1])
    tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    texture = reflectance(material)
    assert extremes(texture)[0] == pytest.approx((0.2,) * 3)
    assert extremes(texture)[1] == pytest.approx((0.95,) * 3)


def test_worlds_are_textures_of_all_directions():
    tree = blender.set_world((0.1, 0.2, 0.3)).node_tree
    background = next(n for n in tree.nodes if n.type == "BACKGROUND")
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], background.inputs["Color"])
    scene, warnings = blender.export()
    assert warnings == ()
    assert scene.world.radiance.key == "noise"
