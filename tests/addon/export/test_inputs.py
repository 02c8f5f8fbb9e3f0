"""Input nodes become textures that ask for what they say; meshes and objects bring what is asked for, and nothing else."""

import bpy
import numpy as np
import pytest

from glanz.addon.export.hashes import unit_of, unit_of_name
from glanz.engine import Attribute, BumpMap, CameraData, Coordinates, Fresnel, Geometry, LayerWeight, LightPath, ObjectValue, Tangent
from glanz.engine.scene.graphs import with_inner
from glanz.tests.addon import blender


def asking(kind, output, **properties):
    """A material that glows with what a node gives; and the node."""
    material = blender.new_material("Mat", "ShaderNodeEmission")
    tree = material.node_tree
    node = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in properties.items():
        setattr(node, name, value)
    emission = next(n for n in tree.nodes if n.type == "EMISSION")
    tree.links.new(next(s for s in node.outputs if s.identifier == output), emission.inputs["Color"])
    return material, node


def exported(material, ob=None):
    """(the object, the texture that it glows with or a constant, warnings)."""
    ob = ob or blender.add_plane()
    ob.data.materials.append(material)
    scene, warnings = blender.export()
    (o,) = (o for o in scene.objects if o.name == ob.name)
    return o, o.materials[0].emission, warnings


CASES = {
    "normal": ("TexCoord", "Normal", Geometry, {"output": "object normal"}),
    "reflection": ("TexCoord", "Reflection", Geometry, {"output": "reflection"}),
    "window": ("TexCoord", "Window", CameraData, {"output": "window"}),
    "backfacing": ("NewGeometry", "Backfacing", Geometry, {"output": "backfacing"}),
    "tangent of the geometry": ("NewGeometry", "Tangent", Tangent, {"direction": "z"}),
    "pointiness": ("NewGeometry", "Pointiness", Attribute, {"name": ".pointiness", "output": "number"}),
    "location": ("ObjectInfo", "Location", ObjectValue, {"name": "location", "output": "colour"}),
    "alpha of the object": ("ObjectInfo", "Alpha", ObjectValue, {"name": "colour", "output": "alpha"}),
    "age": ("ParticleInfo", "Age", ObjectValue, {"name": "particle age", "output": "number"}),
    "colour attribute": ("VertexColor", "Color", Attribute, {"name": "", "output": "colour"}),
    "fresnel": ("Fresnel", "Fac", Fresnel, {"ior": pytest.approx(1.5), "normal": None}),
    "facing": ("LayerWeight", "Facing", LayerWeight, {"blend": 0.5, "normal": None, "output": "facing"}),
    "camera ray": ("LightPath", "Is Camera Ray", LightPath, {"output": "camera"}),
    "ray length": ("LightPath", "Ray Length", LightPath, {"output": "length"}),
    "transparent depth": ("LightPath", "Transparent Depth", LightPath, {"output": "transparent depth"}),
    "depth": ("CameraData", "View Z Depth", CameraData, {"output": "depth"}),
}


@pytest.mark.parametrize("name", CASES)
def test_an_input_node_asks_for_what_it_says(name):
    kind, output, texture, fields = CASES[name]
    _, found, warnings = exported(asking(kind, output)[0])
    assert warnings == ()
    assert type(found) is texture
    assert {field: getattr(found, field) for field in fields} == fields


def test_the_index_of_a_material_is_a_constant_also_in_a_group():
    material, _ = asking("ObjectInfo", "Material Index")
    material.pass_index = 7
    assert exported(material)[1] == (7, 7, 7)


def test_coordinates_of_another_object_are_places_in_its_space():
    other = blender.link("Other", None, (1, 2, 3))
    other.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    material, _ = asking("TexCoord", "Object", object=other)
    _, found, _ = exported(material)
    (coordinates,) = [x for t in with_inner(found) for x in getattr(t, "textures", ()) if isinstance(x, Coordinates)]
    assert coordinates.source == "position"
    np.testing.assert_allclose(np.array(coordinates.matrix) @ (3, 2, 3, 1), (1, 0, 0, 1), atol=1e-6)


def test_a_bump_may_feed_fresnel():
    material, node = asking("Fresnel", "Fac")
    tree = material.node_tree
    bump, noise = tree.nodes.new("ShaderNodeBump"), tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs[0], blender.node_input(bump, "Height"))
    tree.links.new(bump.outputs[0], blender.node_input(node, "Normal"))
    assert type(exported(material)[1].normal) is BumpMap


@pytest.mark.parametrize(
    ("kind", "output", "words"),
    [
        ("AmbientOcclusion", "Color", "Ambient Occlusion"),
        ("Bevel", "Normal", "Bevel"),
        ("HairInfo", "Intercept", "meshes"),
        ("VolumeInfo", "Density", "meshes"),
    ],
)
def test_what_is_not_what_it_says_is_named(kind, output, words):
    _, _, warnings = exported(asking(kind, output)[0])
    assert any(words in line and "material 'Mat'" in line for line in warnings)


def plane_with_attributes():
    plane = blender.add_plane()
    for name, kind, domain, prop, values in (
        ("weight", "FLOAT", "POINT", "value", [0.1, 0.2, 0.3, 0.4]),
        ("paint", "FLOAT_COLOR", "CORNER", "color", np.arange(16) / 16),
        ("face", "INT", "FACE", "value", [3]),
    ):
        plane.data.attributes.new(name, kind, domain).data.foreach_set(prop, values)
    return plane


@pytest.mark.parametrize(("name", "components"), [("weight", 1), ("paint", 4), ("face", 1)])
def test_meshes_bring_the_attributes_that_are_asked_for_and_no_others(name, components):
    o, _, warnings = exported(asking("Attribute", "Color", attribute_name=name)[0], plane_with_attributes())
    assert warnings == ()
    (attribute,) = o.mesh.attributes
    assert (attribute.name, len(attribute.values)) == (name, components)
    if name == "paint":
        # As it was set, corner by corner.
        loops = np.array([t.loops for t in bpy.data.meshes[0].loop_triangles]).T
        np.testing.assert_array_equal(attribute.indices, loops)
        np.testing.assert_allclose(attribute.values, (np.arange(16) / 16).reshape(4, 4).T)


def test_a_mesh_without_the_attribute_brings_none():
    o, _, _ = exported(asking("Attribute", "Color", attribute_name="lost")[0], plane_with_attributes())
    assert o.mesh.attributes == ()


def test_a_material_that_asks_for_nothing_costs_nothing():
    o, _, _ = exported(blender.new_material("Plain", "ShaderNodeEmission"), plane_with_attributes())
    assert (o.mesh.attributes, o.mesh.uv_layers, o.values) == ((), (), ())


def test_objects_bring_their_values():
    plane = blender.add_plane("Named")
    plane.color, plane["mine"], plane["vector"] = (0.25, 0.5, 0.75, 0.5), 3, (0.5, 1.5, 2.5)
    for properties, value in (
        ({"attribute_name": "color"}, (0.25, 0.5, 0.75, 0.5)),
        ({"attribute_name": "mine"}, (3, 3, 3, 1)),
        ({"attribute_name": "vector"}, (0.5, 1.5, 2.5, 1)),
        ({"attribute_name": "location"}, (0, 0, 0, 1)),
    ):
        plane.data.materials.clear()
        o, _, _ = exported(asking("Attribute", "Color", attribute_type="OBJECT", **properties)[0], plane)
        assert o.values == ((f"object {properties['attribute_name']}", value),)
    plane.data.materials.clear()
    o, _, _ = exported(asking("ObjectInfo", "Random")[0], plane)
    assert dict(o.values)["random"][0] == pytest.approx(unit_of_name("Named"))


def test_random_numbers_are_those_of_cycles():
    """By values that Cycles has shown."""
    assert [unit_of_name(name) for name in ("Plane", "Ball", "Flat")] == pytest.approx([0.135764, 0.723851, 0.779734], abs=1e-6)
    numbers = unit_of(np.arange(1000), np.zeros(1000))
    assert 0.45 < numbers.mean() < 0.55
    assert np.unique(numbers).size > 990


@pytest.mark.parametrize("output", ["UV", "Generated", "Object"])
def test_aovs_may_be_coordinates(output, tmp_path):
    """Straight from the node, with nothing between; each is there, and none ends the render."""
    blender.add_camera(width=8, height=8)
    layer = bpy.context.view_layer
    layer.aovs.add().name = "place"
    material = bpy.data.materials.new("M")
    tree = blender.new_nodes(material)
    aov = tree.nodes.new("ShaderNodeOutputAOV")
    aov.aov_name = "place"
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs[output], aov.inputs["Color"])
    blender.add_plane(size=8).data.materials.append(material)
    found = blender.read_exr(blender.render(tmp_path / "a.exr"))
    values = next(values for name, values in found.items() if name.endswith("place"))
    assert (np.ptp(values[..., 0]) > 0) == (output != "UV")
