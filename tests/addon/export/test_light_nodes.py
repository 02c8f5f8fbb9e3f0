"""Node trees of lights: constants become strengths, what varies a shade; what is missing is told of the light by its name."""

import bpy
import numpy as np
import pytest

from glanz.engine import CheckerTexture, ImageTexture, LightFalloff
from glanz.engine.scene.graphs import with_inner
from glanz.tests.addon import blender

IES = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 2 3 1 1 2 0 0 0\n1 1 40\n0 45 90\n0\n100 50 0\n"


def new_light(kind="POINT", name="Key", feed=None, socket="Color", **node):
    """A light whose Emission node is fed by a node of type `feed`, through its first output."""
    data = bpy.data.lights.new(name, kind)
    tree = blender.new_nodes(data)
    emission, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputLight")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    if feed:
        found = tree.nodes.new(feed)
        for attribute, value in node.items():
            setattr(found, attribute, value)
        tree.links.new(found.outputs[0], emission.inputs[socket])
    return blender.link(name, data)


def exported():
    scene, warnings = blender.export()
    return scene.lights, warnings


def test_constants_are_strengths_and_leave_no_shade():
    light = new_light(feed="ShaderNodeBlackbody")
    node = next(n for n in light.data.node_tree.nodes if n.type == "BLACKBODY")
    blender.node_input(node, "Temperature").default_value = 2500
    (found,), warnings = exported()
    assert found.shade is None
    assert found.intensity[0] > 2 * found.intensity[2]
    assert warnings == ()


@pytest.mark.parametrize("kind", ["POINT", "SPOT", "SUN", "AREA"])
def test_textures_are_shades_in_the_frame_of_the_light(kind):
    light = new_light(kind, feed="ShaderNodeTexChecker")
    light.location, light.rotation_euler, light.scale = (1, 2, 3), (0.3, 0.2, 0.1), (1, 2, 1)
    (found,), warnings = exported()
    # Older Cycles asks in the frame of the world, which is told.
    assert len(warnings) == (bpy.app.version < (4, 5))
    assert type(found.shade.texture) is CheckerTexture
    np.testing.assert_allclose(found.shade.world_from_light, np.array(light.matrix_world), atol=1e-7)


def test_lights_that_share_their_nodes_share_a_texture_but_not_their_random_number():
    first = new_light(feed="ShaderNodeObjectInfo")
    tree = first.data.node_tree
    emission = next(n for n in tree.nodes if n.type == "EMISSION")
    info = next(n for n in tree.nodes if n.type == "OBJECT_INFO")
    tree.links.new(next(s for s in info.outputs if s.identifier == "Random"), emission.inputs["Color"])
    blender.link("Fill", first.data)
    (a, b), _ = exported()
    assert a.shade.texture is b.shade.texture
    assert dict(a.shade.values)["random"] != dict(b.shade.values)["random"]


@pytest.mark.parametrize("falloff", ["quadratic", "linear", "constant"])
def test_light_falloff_keeps_its_law(falloff):
    light = new_light("AREA", feed="ShaderNodeLightFalloff", socket="Strength")
    tree = light.data.node_tree
    emission, node = (next(n for n in tree.nodes if n.type == kind) for kind in ("EMISSION", "LIGHT_FALLOFF"))
    blender.node_input(node, "Smooth").default_value = 0.5
    tree.links.new(node.outputs[falloff.title()], emission.inputs["Strength"])
    (found,), _ = exported()
    (law,) = (part for part in with_inner(found.shade.texture) if type(part) is LightFalloff)
    assert (law.falloff, law.strength, law.smooth) == (falloff, 100.0, 0.5)


def test_a_missing_image_is_told_of_the_light():
    new_light("SPOT", "Gobo", feed="ShaderNodeTexImage")
    (found,), warnings = exported()
    assert any(type(part) is ImageTexture for part in with_inner(found.shade.texture))
    assert warnings == ("the image is missing and is rendered magenta: node 'Image Texture' of light 'Gobo'",)


def ies_of(light):
    return next(part for part in with_inner(light.shade.texture) if part.key == "ies")


def test_ies_tables_are_read_from_texts_and_from_files(tmp_path):
    text = bpy.data.texts.new("bulb.ies")
    text.write(IES)
    (tmp_path / "lamp.ies").write_bytes(IES.replace("TILT", "[MANUFAC] Löwe\nTILT").encode("latin-1"))
    new_light(name="a", feed="ShaderNodeTexIES", socket="Strength", mode="INTERNAL", ies=text)
    new_light(name="b", feed="ShaderNodeTexIES", socket="Strength", mode="EXTERNAL", filepath=str(tmp_path / "lamp.ies"))
    lights, warnings = exported()
    assert warnings == ()
    for light in lights:
        np.testing.assert_allclose(ies_of(light).intensity[0], np.array((200, 100, 0)) * 4 * np.pi / 177.83)
        np.testing.assert_allclose(ies_of(light).vertical, (0, 45, 90))


@pytest.mark.parametrize("content", [None, "", "TILT=NONE\n1 2", IES.replace(" 3 1 1 2", " 3 1 9 2")])
def test_an_ies_file_that_cannot_be_read_is_told_of_the_light(content):
    text = None
    if content is not None:
        text = bpy.data.texts.new("bulb.ies")
        text.write(content)
    new_light(name="Lamp", feed="ShaderNodeTexIES", socket="Strength", mode="INTERNAL", ies=text)
    (found,), warnings = exported()
    assert len(warnings) == 1
    assert "IES" in warnings[0]
    assert "light 'Lamp'" in warnings[0]
    texture = ies_of(found)
    assert (texture.intensity == 100).all() and not texture.falls_off
    texture.check("light 'Lamp'")


def test_a_file_that_is_not_there_is_told_of_the_light():
    new_light(name="Lamp", feed="ShaderNodeTexIES", socket="Strength", mode="EXTERNAL", filepath="//nowhere.ies")
    assert "light 'Lamp'" in exported()[1][0]


@pytest.mark.parametrize("is_linked", [False, True])
def test_the_strength_of_an_ies_file_that_is_not_there_counts(is_linked):
    light = new_light(feed="ShaderNodeTexIES", socket="Strength", mode="EXTERNAL", filepath="/nowhere.ies")
    tree = light.data.node_tree
    strength = blender.node_input(next(n for n in tree.nodes if n.type == "TEX_IES"), "Strength")
    strength.default_value = 0.5
    if is_linked:
        tree.links.new(blender.add_node(tree, "ShaderNodeLightFalloff", Strength=0.5).outputs["Quadratic"], strength)
    texture = ies_of(exported()[0][0])
    assert (texture.intensity == 100).all()
    assert isinstance(texture.strength, LightFalloff) if is_linked else texture.strength == 0.5
