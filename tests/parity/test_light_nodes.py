"""Lights shine through textures as in Cycles: pictures, patterns, falloffs and the tables of lamp makers.

The plane of test_lights, in 16 blocks. One seed differs from another by a third of what is allowed at most.
"""

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender
from glanz.tests.parity import parity
from glanz.tests.parity.test_lights import TURN, add_light, look_at_plane

TOLERANCE = 0.01
SAMPLES = 256
VERTICAL, HORIZONTAL = (0, 20, 45, 70, 90, 130, 180), (0, 90, 200, 300, 360)


def picture(tree):
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("Gobo", 4, 3, float_buffer=True)
    node.image.colorspace_settings.name = "Non-Color"
    pixels = np.random.default_rng(3).random((3, 4, 4)).astype(np.float32)
    pixels[..., 3] = 1
    node.image.pixels.foreach_set(pixels.ravel())
    node.image.update()
    node.image.pack()
    return node


def pattern(kind, coordinates=None, **inputs):
    def build(tree):
        node = blender.add_node(tree, f"ShaderNodeTex{kind}", **inputs)
        if coordinates:
            source = tree.nodes.new("ShaderNodeTexCoord")
            tree.links.new(source.outputs[coordinates], node.inputs["Vector"])
        return node

    return build


def falloff(output):
    """The node, whose output of this name comes first."""

    def build(tree):
        return blender.add_node(tree, "ShaderNodeLightFalloff", Strength=1.3, Smooth=0.4), output

    return build


def ies(tree):
    values = 1000 * np.random.default_rng(1).random((len(HORIZONTAL), len(VERTICAL)))
    head = f"IESNA:LM-63-2002\nTILT=NONE\n1 -1 0.02 {len(VERTICAL)} {len(HORIZONTAL)} 1 2 0 0 0\n0.9 1 40\n"
    text = bpy.data.texts.new("lamp.ies")
    text.write(head + "\n".join(" ".join(f"{x:.2f}" for x in row) for row in (VERTICAL, HORIZONTAL, *values)) + "\n")
    node = tree.nodes.new("ShaderNodeTexIES")
    node.mode, node.ies = "INTERNAL", text
    return node


BULB = {"shadow_soft_size": 0.2}
BALL = {"shadow_soft_size": 0.3, "use_soft_falloff": False}
SPOT = {"spot_size": 1.6, "spot_blend": 0.3, "shadow_soft_size": 0.05}
SQUARE = {"shape": "RECTANGLE", "size": 0.9, "size_y": 0.5, "stretch": (-1.3, 0.8, 2.0)}
CASES = {
    "area with a checker": ("AREA", SQUARE, pattern("Checker", "UV", Scale=3.0)),
    "area with noise": ("AREA", SQUARE, pattern("Noise", Scale=4.0)),
    "spot with a picture": ("SPOT", SPOT, picture),
    "spot by directions": ("SPOT", SPOT, pattern("Noise", "Normal", Scale=3.0)),
    "bulb with a picture": ("POINT", BULB, picture),
    "ball with noise": ("POINT", BALL, pattern("Noise", "Object", Scale=4.0)),
    "bulb with a table": ("POINT", BULB, ies),
    "area with a table": ("AREA", SQUARE, ies),
    "sun with a picture": ("SUN", {"angle": 0.6}, picture),
    "bulb, quadratic": ("POINT", BULB, falloff("Quadratic")),
    "spot, linear": ("SPOT", SPOT, falloff("Linear")),
    "area, constant": ("AREA", SQUARE, falloff("Constant")),
    "sun, linear": ("SUN", {"angle": 0.2}, falloff("Linear")),
}
SINCE_4_5 = ("area with noise", "ball with noise", "sun, linear")


def add_textured_light(kind, attributes, build):
    light = add_light(kind, turn=TURN, **attributes)
    tree = blender.new_nodes(light)
    emission, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputLight")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    found = build(tree)
    node, name = found if isinstance(found, tuple) else (found, None)
    socket = node.outputs[name] if name else node.outputs[0]
    tree.links.new(socket, emission.inputs["Strength" if socket.type == "VALUE" else "Color"])
    return node


@pytest.mark.parametrize("case", CASES)
def test_a_light_shines_through_its_nodes_as_in_cycles(case, tmp_path):
    if case in SINCE_4_5 and bpy.app.version < (4, 5):
        pytest.skip("before, lights had no frame of their own, and Light Falloff blinded suns")
    look_at_plane(1.0)
    add_textured_light(*CASES[case])
    parity.be_exact(SAMPLES, max_depth=0)
    cycles, glanz = parity.pixels("CYCLES", tmp_path), parity.pixels("GLANZ", tmp_path)
    assert parity.difference(glanz, cycles) < TOLERANCE
    assert parity.difference(1.02 * glanz, cycles) > TOLERANCE


def test_a_gobo_that_is_turned_by_a_few_degrees_is_noticed(tmp_path):
    look_at_plane(1.0)
    add_textured_light(*CASES["spot with a picture"])
    parity.be_exact(SAMPLES, max_depth=0)
    cycles = parity.pixels("CYCLES", tmp_path)
    light = next(ob for ob in bpy.data.objects if ob.type == "LIGHT")
    light.rotation_euler.rotate_axis("Z", 0.1)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles) > TOLERANCE
