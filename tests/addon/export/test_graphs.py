"""Node trees that share their parts, and node trees without an end."""

import bpy
import pytest

from glanz.addon.export.nodes import DEEPEST
from glanz.engine import NoiseTexture
from glanz.engine.scene.graphs import with_inner
from glanz.tests.addon import blender

_MIXES = 60
"""If each were read twice where it is used twice, no machine would see the end."""


def chain(kind, first, socket_type, count):
    """A plane whose material feeds `count` nodes of a kind, each into both inputs of the next one, the first by the node `first`."""
    material = bpy.data.materials.new("Deep")
    tree = blender.new_nodes(material)
    output = tree.nodes.new(first).outputs[0]
    for _ in range(count):
        node = tree.nodes.new(kind)
        for socket in [s for s in node.inputs if s.type == socket_type][-2:] if socket_type == "SHADER" else node.inputs[:2]:
            tree.links.new(output, socket)
        output = node.outputs[0]
    if output.type != "SHADER":
        shader = tree.nodes.new("ShaderNodeEmission")
        tree.links.new(output, shader.inputs["Color"])
        output = shader.outputs[0]
    tree.links.new(output, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    blender.add_plane().data.materials.append(material)
    scene, warnings = blender.export()
    return scene.objects[0].materials[0], warnings


def test_a_shader_that_is_mixed_with_itself_again_and_again_stays_one():
    material, warnings = chain("ShaderNodeMixShader", "ShaderNodeBsdfDiffuse", "SHADER", _MIXES)
    assert warnings == ()
    (lobe,) = material.lobes
    assert lobe.reflectance == pytest.approx((0.8,) * 3)


def test_a_value_that_feeds_both_inputs_again_and_again_is_read_once():
    material, warnings = chain("ShaderNodeMath", "ShaderNodeTexNoise", "VALUE", _MIXES)
    assert warnings == ()
    assert sum(type(part) is NoiseTexture for part in with_inner(material.emission)) == 1
    assert len(with_inner(material.emission)) <= _MIXES + 3


@pytest.mark.parametrize(
    ("kind", "first", "socket_type"),
    [("ShaderNodeMath", "ShaderNodeTexNoise", "VALUE"), ("ShaderNodeMixShader", "ShaderNodeBsdfDiffuse", "SHADER")],
)
def test_what_is_too_deep_for_the_stack_is_cut_off_and_named(kind, first, socket_type, tmp_path):
    _, warnings = chain(kind, first, socket_type, 3 * DEEPEST)
    assert any("deep" in line and "material 'Deep'" in line for line in warnings)
    pixels = blender.read_exr(blender.render(tmp_path / "deep.exr"))
    assert pixels


def test_what_is_as_deep_as_allowed_is_rendered(tmp_path):
    _, warnings = chain("ShaderNodeMath", "ShaderNodeTexNoise", "VALUE", DEEPEST - 4)
    assert warnings == ()
    assert blender.read_exr(blender.render(tmp_path / "deep.exr"))
