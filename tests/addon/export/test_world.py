"""The world is one radiance; what is more than that is named."""

import bpy
import pytest

from glanz.tests.addon import blender


def test_background_is_colour_times_strength():
    blender.set_world((0.1, 0.2, 0.4), 5)
    scene, warnings = blender.export()
    assert scene.world.radiance == pytest.approx((0.5, 1, 2))
    assert warnings == ()


def test_no_world_is_black():
    bpy.context.scene.world = None
    assert blender.export()[0].world.radiance == (0, 0, 0)


def test_an_unlinked_output_is_black():
    world = blender.set_world((1, 1, 1))
    world.node_tree.links.clear()
    assert blender.export()[0].world.radiance == (0, 0, 0)


def test_no_output_is_black_and_named():
    world = blender.set_world((1, 1, 1))
    world.node_tree.nodes.clear()
    scene, warnings = blender.export()
    assert scene.world.radiance == (0, 0, 0)
    assert "world 'World'" in warnings[0]


def test_pictures_of_the_sky_are_named_and_replaced_by_the_nodes_own_colour():
    world = blender.set_world((0.3, 0.3, 0.3))
    tree = world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    tree.links.new(tree.nodes.new("ShaderNodeTexEnvironment").outputs["Color"], background.inputs["Color"])
    scene, warnings = blender.export()
    assert scene.world.radiance == pytest.approx((0.3, 0.3, 0.3))
    assert "Environment Texture" in warnings[0]
    assert "world 'World'" in warnings[0]


@pytest.mark.skipif(bpy.app.version >= (5, 0), reason="from Blender 5.0 on every world has nodes")
def test_without_nodes_the_viewport_colour_counts():
    world = bpy.data.worlds.new("Plain")
    world.color = (0.1, 0.2, 0.3)
    bpy.context.scene.world = world
    assert blender.export()[0].world.radiance == pytest.approx((0.1, 0.2, 0.3))


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="view layers override the world from Blender 5.0 on")
def test_a_view_layers_world_override_counts():
    override = blender.set_world((0, 1, 0))
    blender.set_world((1, 0, 0))
    bpy.context.view_layer.world_override = override
    assert blender.export()[0].world.radiance == (0, 1, 0)


@pytest.mark.parametrize(
    ("setting", "words"),
    [("use_motion_blur", "motion blur"), ("film_transparent", "film"), ("use_freestyle", "freestyle")],
)
def test_render_settings_that_are_not_followed_are_named(setting, words):
    setattr(bpy.context.scene.render, setting, True)
    warnings = blender.export()[1]
    assert len(warnings) == 1
    assert words in warnings[0]
    assert "scene 'Scene'" in warnings[0]
