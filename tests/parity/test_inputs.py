"""Input nodes on balls, on instances and along paths are those of Cycles.

The comparison of all nodes (`nodes/`) shows them on one square; here are meshes with seams and islands, seen by a camera in perspective,
particles and other instances, and materials that know what kind of ray they are seen by.
"""

import math

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender
from glanz.tests.parity import parity

SIDE = 64
NEAR = 1 / 255
ATTRIBUTES = {
    "float": ("FLOAT", "POINT"),
    "vector": ("FLOAT_VECTOR", "CORNER"),
    "colour": ("FLOAT_COLOR", "POINT"),
    "bytes": ("BYTE_COLOR", "CORNER"),
    "whole": ("INT", "FACE"),
    "truth": ("BOOLEAN", "POINT"),
    "plane": ("FLOAT2", "POINT"),
    "edge": ("FLOAT", "EDGE"),
}


def ball(name, location, smooth, rings, segments):
    # Only there once bpy is.
    import bmesh

    mesh = bpy.data.meshes.new(name)
    made = bmesh.new()
    bmesh.ops.create_uvsphere(made, u_segments=segments, v_segments=rings, radius=0.6)
    layer = made.loops.layers.uv.verify()
    for face in made.faces:
        face.smooth = smooth
        for corner in face.loops:
            x, y, z = corner.vert.co
            corner[layer].uv = (math.atan2(y, x + 0.013) / 6.28 + 0.5 + 0.1 * z, 0.7 * z + 0.5)
    made.to_mesh(mesh)
    made.free()
    add_attributes(mesh)
    return blender.link(name, mesh, location)


def add_attributes(mesh):
    rng = np.random.default_rng(len(mesh.vertices))
    for name, (kind, domain) in ATTRIBUTES.items():
        attribute = mesh.attributes.new(name, kind, domain)
        prop, count = {"FLOAT2": ("vector", 2), "FLOAT_VECTOR": ("vector", 3)}.get(kind, ("color", 4) if "COLOR" in kind else ("value", 1))
        values = rng.random(len(attribute.data) * count).astype(np.float32)
        attribute.data.foreach_set(prop, {"INT": (3 * values).astype(np.int32), "BOOLEAN": values > 0.5}.get(kind, values))
    mesh.color_attributes.active_color_name = "bytes"
    mesh.color_attributes.render_color_index = mesh.color_attributes.find("bytes")


def glow(kind, output, values=None, links=None, **properties):
    """A material that glows with half of what a node gives, plus a half."""
    material = bpy.data.materials.new("Glow")
    material.pass_index = 3
    tree = blender.new_nodes(material)
    node = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in properties.items():
        setattr(node, name, value)
    for name, value in (values or {}).items():
        blender.node_input(node, name).default_value = value
    for name, (other, inputs) in (links or {}).items():
        tree.links.new(blender.add_node(tree, f"ShaderNode{other}", **inputs).outputs[-1], blender.node_input(node, name))
    glows = [blender.add_node(tree, "ShaderNodeEmission", Strength=0.5) for _ in range(2)]
    tree.links.new(next(s for s in node.outputs if s.identifier == output), glows[0].inputs["Color"])
    glows[1].inputs["Color"].default_value = (1, 1, 1, 1)
    both = tree.nodes.new("ShaderNodeAddShader")
    for shader, socket in zip(glows, both.inputs):
        tree.links.new(shader.outputs[0], socket)
    tree.links.new(both.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def balls(material, mirrored=False):
    blender.add_camera((0.3, -2.0, 4.2), SIDE, SIDE, lens=40.0, shift_x=0.05).rotation_euler = (0.42, 0.06, 0.1)
    smooth, flat = ball("Ball", (0.4, 0.1, 0.5), True, 12, 20), ball("Flat", (-0.7, -0.3, 0.4), False, 6, 8)
    smooth.rotation_euler, smooth.scale = (0.3, 0.5, 0.7), (-1.0 if mirrored else 1.0, 1.3, 0.7)
    for i, ob in enumerate((smooth, flat)):
        ob.color, ob.pass_index, ob["prop"] = (0.9, 0.3, 0.1 + 0.5 * i, 0.2), i + 1, 0.3 + 0.4 * i
        ob.vertex_groups.new(name="group").add(list(range(0, len(ob.data.vertices), 2)), 0.7, "REPLACE")
        ob.data.materials.append(material)
    bpy.context.scene["prop"] = 0.25


def share(path):
    parity.be_exact(1, max_depth=0)
    scene = bpy.context.scene
    scene.glanz.pixel_filter, scene.cycles.pixel_filter_type = "blackman_harris", "BLACKMAN_HARRIS"
    scene.glanz.filter_width = scene.cycles.filter_width = 0.01
    scene.glanz.filter_textures = False
    a, b = parity.pixels("GLANZ", path), parity.pixels("CYCLES", path)
    assert b.std() > 0.05
    return (np.abs(a - np.maximum(b, 0)) <= NEAR * np.maximum(1, b)).all(axis=2).mean()


NOISE = ("TexNoise", {"Scale": 3.0, "Detail": 0.0})
CASES = {
    **{f"{o} of the geometry": ("NewGeometry", o) for o in ("Normal", "True Normal", "Tangent", "Parametric")},
    **{f"{o} of the mesh": ("NewGeometry", o) for o in ("Pointiness", "Random Per Island")},
    **{f"{o} coordinates": ("TexCoord", o) for o in ("Normal", "Camera", "Window", "Reflection", "Object")},
    **{f"attribute {name}": ("Attribute", "Color", None, None, {"attribute_name": name}) for name in (*ATTRIBUTES, "group", "position")},
    "number of a vector": ("Attribute", "Fac", None, None, {"attribute_name": "vector"}),
    "alpha of a colour": ("Attribute", "Alpha", None, None, {"attribute_name": "colour"}),
    "the default colour": ("VertexColor", "Color"),
    "a property of the object": ("Attribute", "Fac", None, None, {"attribute_name": "prop", "attribute_type": "OBJECT"}),
    "a value of the object": ("Attribute", "Color", None, None, {"attribute_name": "location", "attribute_type": "OBJECT"}),
    "a property of the scene": ("Attribute", "Fac", None, None, {"attribute_name": "prop", "attribute_type": "VIEW_LAYER"}),
    **{f"{o} of the object": ("ObjectInfo", o) for o in ("Location", "Color", "Alpha", "Object Index", "Material Index", "Random")},
    "tangent along u": ("Tangent", "Tangent", None, None, {"direction_type": "UV_MAP"}),
    "tangent about x": ("Tangent", "Tangent", None, None, {"axis": "X"}),
    "Fresnel": ("Fresnel", "Fac", {"IOR": 1.8}),
    "bumped Fresnel": ("Fresnel", "Fac", None, {"Normal": ("Bump", {})}),
    "facing": ("LayerWeight", "Facing", {"Blend": 0.7}),
    "bump": ("Bump", "Normal", {"Strength": 0.8, "Distance": 0.3}, {"Height": NOISE}),
    **{
        f"normal map in {space}": ("NormalMap", "Normal", {"Strength": 0.6}, {"Color": NOISE}, {"space": space})
        for space in ("TANGENT", "OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD")
    },
    "wires": ("Wireframe", "Fac", {"Size": 0.05}),
    "length of rays": ("LightPath", "Ray Length"),
    "distance": ("CameraData", "View Distance"),
}


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("name", CASES)
def test_an_input_on_balls_is_that_of_cycles(name, mirrored, tmp_path):
    kind, output, values, links, properties = (*CASES[name], None, None, None)[:5]
    if mirrored and kind in ("ObjectInfo", "CameraData", "LightPath", "Fresnel", "LayerWeight", "Wireframe"):
        pytest.skip("what is the same in a mirror")
    balls(glow(kind, output, values, links, **(properties or {})), mirrored)
    # The steps between heights are a pixel wide, where both engines measure pixels by their own means.
    assert share(tmp_path) >= (0.98 if kind == "Bump" else 0.99)


def test_balls_catch_tangents_that_do_not_vary(tmp_path, monkeypatch):
    from glanz.engine.maths import tangents

    monkeypatch.setattr(tangents, "_hashes", lambda rows: np.arange(rows.shape[1]))
    with pytest.raises(AssertionError):
        test_an_input_on_balls_is_that_of_cycles("tangent along u", False, tmp_path)


def instances(material):
    """Particles, instances on faces, and of a collection, all of one material."""
    blender.add_camera((0, 0, 6), SIDE, SIDE, type="ORTHO", ortho_scale=4.5).rotation_euler = (0.1, 0.05, 0)
    leaf = blender.add_plane("Leaf", size=0.35, location=(9, 9, 9))
    leaf["prop"] = 0.3
    tree = blender.add_plane("Tree", size=2.0, location=(-1.1, 1.1, 0))
    tree["prop"], tree.color, tree.show_instancer_for_render = 0.6, (0.1, 0.7, 0.4, 0.5), False
    tree.modifiers.new("Leaves", "PARTICLE_SYSTEM")
    settings = tree.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 12, -8, 1, 50
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", leaf, 1.0
    settings.size_random, settings.lifetime_random, settings.normal_factor, settings.factor_random = 0.5, 0.4, 0.3, 0.2
    settings.use_rotations, settings.angular_velocity_mode, settings.angular_velocity_factor = True, "VELOCITY", 2
    faces = blender.add_plane("Faces", size=1.2, location=(1.1, 1.1, 0))
    faces.data.uv_layers.new(name="UVMap").uv.foreach_set("vector", [0.1, 0.2, 0.9, 0.1, 0.8, 0.9, 0.2, 0.7])
    faces.instance_type, faces.show_instancer_for_render, faces["prop"] = "FACES", False, 0.8
    kid = blender.add_plane("Kid", size=0.5)
    kid.parent, kid.pass_index = faces, 4
    collected = blender.add_plane("Collected", size=0.6)
    bpy.context.scene.collection.objects.unlink(collected)
    collection = bpy.data.collections.new("Collection")
    collection.objects.link(collected)
    for i, place in enumerate(((-1.1, -1.1, 0), (0, -1.2, 0.2))):
        empty = blender.link(f"Empty {i}", None, place)
        empty.instance_type, empty.instance_collection, empty["prop"] = "COLLECTION", collection, 0.2 + 0.3 * i
        empty.color = (0.9, 0.2 + 0.5 * i, 0.1, 1)
    for ob in (leaf, kid, collected):
        ob.data.materials.append(material)
    bpy.context.scene.frame_set(1)


INSTANCES = {
    **{f"{o} of the object": ("ObjectInfo", o) for o in ("Location", "Color", "Object Index", "Random")},
    **{
        f"{o} of the particle": ("ParticleInfo", o)
        for o in ("Index", "Random", "Age", "Lifetime", "Location", "Size", "Velocity", "Angular Velocity")
    },
    "UV from the instancer": ("TexCoord", "UV", {"from_instancer": True}),
    "Generated from the instancer": ("TexCoord", "Generated", {"from_instancer": True}),
    "a property of the instancer": ("Attribute", "Fac", {"attribute_name": "prop", "attribute_type": "INSTANCER"}),
}


@pytest.mark.parametrize("name", INSTANCES)
def test_an_input_on_instances_is_that_of_cycles(name, tmp_path):
    kind, output, properties = (*INSTANCES[name], {})[:3]
    instances(glow(kind, output, **properties))
    # Particles are simulated anew for the first render, and only then stay what they are.
    parity.pixels("GLANZ", tmp_path)
    assert share(tmp_path) >= 0.99


def lit_by_kind(output, shaders):
    """A floor and a ball whose material is the first of `shaders`, (type, inputs) each, and for one kind of ray the second.

    Only a sun shines where shadow rays are told apart: Cycles sends them to an even world as well, Glanz finds it by scattered rays alone,
    and the two do not see the same.
    """
    blender.add_camera((0, -4, 4), SIDE, SIDE).rotation_euler = (math.pi / 4, 0, 0)
    floor = blender.add_plane(size=20.0)
    floor.data.materials.append(blender.new_material("Floor", "ShaderNodeBsdfDiffuse"))
    blender.set_world((0.5, 0.6, 0.8), 0.0 if output == "Is Shadow Ray" else 0.6)
    material = bpy.data.materials.new("By Kind")
    tree = blender.new_nodes(material)
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(next(s for s in tree.nodes.new("ShaderNodeLightPath").outputs if s.identifier == output), mix.inputs[0])
    for i, (kind, inputs) in enumerate(shaders):
        tree.links.new(blender.add_node(tree, kind, **inputs).outputs[0], mix.inputs[i + 1])
    tree.links.new(mix.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    ball("Ball", (0, 0, 0.7), True, 16, 24).data.materials.append(material)
    sun = blender.link("Sun", bpy.data.lights.new("Sun", "SUN"))
    # Without a size: what glass gathers of it would be noise.
    sun.data.energy, sun.data.angle, sun.rotation_euler = 2.0, 0.0, (0.5, 0.4, 0)


GREY, GLASS = ("ShaderNodeBsdfDiffuse", {}), ("ShaderNodeBsdfGlass", {"Roughness": 0.0})
CLEAR, RED = ("ShaderNodeBsdfTransparent", {}), ("ShaderNodeEmission", {"Color": (1, 0.2, 0.1, 1), "Strength": 2.0})


@pytest.mark.parametrize(
    ("output", "shaders"),
    [("Is Shadow Ray", (GLASS, CLEAR)), ("Is Camera Ray", (GREY, RED)), ("Is Diffuse Ray", (GREY, CLEAR))],
    ids=lambda value: value if isinstance(value, str) else None,
)
def test_materials_that_depend_on_the_kind_of_ray_light_as_those_of_cycles(output, shaders, tmp_path):
    """8 x 8 blocks, to 4 %: what one kind of ray sees is worth 6 % and more somewhere."""
    lit_by_kind(output, shaders)
    parity.be_exact(256, max_depth=4)
    glanz, cycles = parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path)
    assert parity.difference(glanz, cycles, 8) < 0.04
    tree = bpy.data.materials["By Kind"].node_tree
    mix = next(n for n in tree.nodes if n.type == "MIX_SHADER")
    tree.links.remove(mix.inputs[0].links[0])
    mix.inputs[0].default_value = 0.0
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, 8) > 0.06
